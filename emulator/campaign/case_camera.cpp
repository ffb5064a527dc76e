#include "emulator/campaign/case_camera.h"

#include <algorithm>
#include <array>

#include "emulator/scenario/scenario_listing.h"
#include "io/files/value_table_file.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

std::string key_of(const std::string& override) { return override.substr(0, override.find('=')); }

// Turns "objects.12.pose.up" into "pose.up"; empty: the key does not belong to an element of that list.
std::string below_element(const std::string& key, const std::string& list) {
    if (!key.starts_with(list + ".")) return {};
    const std::size_t dot = key.find('.', list.size() + 1);
    return dot == std::string::npos ? std::string() : key.substr(dot + 1);
}

// Stars are placed for the time of loading, and so are terrain and the scenario's own bodies; SPICE kernels
// were checked to cover it.
bool depends_on_time(const ScenarioConfig& s) {
    return (s.stars && !s.stars->catalogue.empty()) || s.terrain || !s.own_bodies.empty() || s.leap_seconds ||
           s.spice;
}

// True for a key that cache file names depend on, except for keys with few values: an object's mesh, the air,
// the transfer table.
bool is_kept_by(const std::string& key) {
    const std::string of_object = below_element(key, "objects");
    const auto begins = [](const std::string& text, const char* with) { return text.starts_with(with); };
    return key == "objects" || begins(key, "atmosphere") || begins(key, "spectrum_edges") ||
           key == "quality.probes" || key == "quality.probe_directions" || key == "quality.source_step_deg" ||
           key == "quality.earth_impostor" || begins(of_object, "mesh") || begins(of_object, "generate") ||
           (begins(of_object, "joints") && !is_taken_over(key, true));
}

}  // namespace

bool is_taken_over(const std::string& key, bool time_is_free) {
    if (key == "seed" || key == "camera.exposure_ms" || key == "camera.gain_db") return true;
    if (key == "time_utc") return time_is_free;
    const auto is_at = [&](const std::string& section) {
        return key == section || key.starts_with(section + ".");
    };
    if (is_at("camera_pose") || is_at("camera_motion")) return true;
    const std::string of_object = below_element(key, "objects");
    // An object's rate decides what is prepared for it.
    if (of_object.starts_with("pose.")) return of_object != "pose.rate_deg_s";
    if (of_object == "motion" || of_object.starts_with("motion.")) return true;
    return below_element(of_object, "joints") == "angle_deg";
}

bool draws_own_shapes(const CampaignConfig& campaign) {
    const auto draws = [](const VaryConfig& vary) {
        const bool comes_again = vary.has_choice || vary.draw.has_choice || vary.draw.has_value;
        return !comes_again && is_kept_by(vary.key);
    };
    if (std::any_of(campaign.vary.begin(), campaign.vary.end(), draws)) return true;
    if (campaign.table.empty()) return false;
    const std::vector<std::string> columns = read_value_table(campaign.table).columns;
    return std::any_of(columns.begin(), columns.end(), is_kept_by);
}

CaseCamera::CaseCamera(const CampaignConfig& campaign)
    : file_(campaign.scenario),
      number_(static_cast<std::size_t>(campaign.camera)),
      target_(static_cast<std::size_t>(campaign.target) - 1) {
    const ScenarioConfig scenario = read(campaign.set);
    if (campaign.view && target_ >= scenario.objects.size())
        throw InputError("target: found " + std::to_string(campaign.target) + "; the scenario has " +
                         std::to_string(scenario.objects.size()) + " objects");
    time_is_free_ = !depends_on_time(scenario);
    sheet_exposure_s_ = scenario.camera.exposure_s;
    has_own_shapes_ = draws_own_shapes(campaign);
    load(scenario, scene_of(campaign.set));
}

ScenarioConfig CaseCamera::read(const std::vector<std::string>& overrides) const {
    const ScenarioConfig bench = load_scenario(file_, overrides);
    if (number_ > 1 + bench.more_cameras.size())
        throw InputError("camera: found " + std::to_string(number_) + "; the scenario has " +
                         std::to_string(1 + bench.more_cameras.size()));
    ScenarioConfig scenario = scenario_of_camera(bench, number_ - 1);
    scenario.has_seed = true;
    return scenario;
}

std::string CaseCamera::scene_of(const std::vector<std::string>& overrides) const {
    std::string scene;
    for (const std::string& override : overrides)
        if (!is_taken_over(key_of(override), time_is_free_)) scene += override + '\n';
    return scene;
}

void CaseCamera::load(const ScenarioConfig& scenario, std::string scene) {
    camera_.reset();  // two scenes may not fit
    scene_ = "\n";    // no case's, should loading fail
    camera_ = std::make_unique<StillCamera>(scenario);
    camera_->renderer().stop_looking_ahead();
    scenario_ = scenario;
    scene_ = std::move(scene);
    ++loads_;
}

void CaseCamera::take(const std::vector<std::string>& overrides) {
    ScenarioConfig scenario = read(overrides);
    std::string scene = scene_of(overrides);
    if (scene != scene_) {
        scenario.is_used_once = has_own_shapes_;
        return load(scenario, std::move(scene));
    }
    camera_->take(scenario);
    scenario_ = scenario;
}

// Makes the sheet without the case's exposure, so that it does not depend on earlier cases.
const CameraSheet& CaseCamera::sheet() {
    CameraModel camera = scenario_.camera;
    camera.exposure_s = sheet_exposure_s_;
    std::string listing = section_listing(section_of(camera));
    if (!sheet_ || listing != sheet_listing_) {
        sheet_ = camera_sheet(camera);
        sheet_listing_ = std::move(listing);
    }
    return *sheet_;
}

void CaseCamera::take_time(double time_offset_s) { camera_->take(scenario_, time_offset_s); }

}  // namespace hilcam
