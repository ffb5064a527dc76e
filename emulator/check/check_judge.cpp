#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "emulator/check/camera_judge.h"
#include "emulator/check/check_report.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// No spacecraft is as long, but the file of one in millimetres is.
constexpr double kLongest_m = 500;
// An object that is smaller, and covers no pixel, is likely to have been scaled twice.
constexpr double kShortest_m = 0.05;
// Most of a constellation's objects are elsewhere.
constexpr std::size_t kMaxTold = 10;
// Less of the Sun than this is an eclipse, less of the disk lit than this is its night side.
constexpr double kDark = 0.02;

std::string size_text(Vec3d size_m) {
    return fmt::format("{:.4g} x {:.4g} x {:.4g} m", size_m.x, size_m.y, size_m.z);
}

double longest_m(const SeenObject& o) {
    const Vec3d size_m = o.loaded.most_m - o.loaded.least_m;
    return std::max({size_m.x, size_m.y, size_m.z});
}

std::string longest_advice(const SeenObject& o) {
    if (!(longest_m(o) > kLongest_m)) return "";
    return "; the file is probably in millimetres: scale: 0.001";
}

// Poses and angles are of the origin of a mesh, which may lie far beside it.
std::string origin_advice(const SeenObject& o) {
    const double off_m = length(0.5 * (o.loaded.least_m + o.loaded.most_m));
    if (!(off_m > length(o.loaded.most_m - o.loaded.least_m))) return "";
    return fmt::format("; that is its origin, and the middle of its mesh is {:.4g} m from there", off_m);
}

void judge_place(const SeenObject& o, const CameraReport& camera, std::vector<std::string>& out) {
    const std::string name = "object '" + harmless(o.loaded.name) + "'";
    if (o.holds_camera) {
        out.push_back(fmt::format("the camera is inside the mesh of {}, which is {}{}", name,
                                  size_text(o.loaded.most_m - o.loaded.least_m), longest_advice(o)));
        return;
    }
    switch (o.place) {
        case SeenObject::Place::kBehind:
            out.push_back(fmt::format("{} is behind the camera, {:.1f} deg off its boresight{}", name,
                                      degrees(o.off_boresight_rad), origin_advice(o)));
            return;
        case SeenObject::Place::kOutside:
            out.push_back(fmt::format(
                "{} is outside the field: {:.2f} deg off the boresight, where the field ends {:.2f} deg "
                "off it at its corners{}",
                name, degrees(o.off_boresight_rad), degrees(0.5 * camera.sheet.field_diagonal_rad),
                origin_advice(o)));
            return;
        case SeenObject::Place::kHidden:
            out.push_back(name + " is hidden: something stands before it");
            return;
        case SeenObject::Place::kVisible:
            break;
    }
    if (longest_m(o) < kShortest_m && o.silhouette_px < 1)
        out.push_back(fmt::format("{} is {} large, {:.2g} pixels from {:.4g} m: is its scale too small?",
                                  name, size_text(o.loaded.most_m - o.loaded.least_m), o.silhouette_px,
                                  o.distance_m));
    if (const std::string advice = longest_advice(o); !advice.empty() && o.distance_m < 10 * kLongest_m)
        out.push_back(fmt::format("{} is {} large and {:.4g} m away{}", name,
                                  size_text(o.loaded.most_m - o.loaded.least_m), o.distance_m, advice));
}

bool any_lamp_lit(const ScenarioConfig& s) {
    return std::any_of(s.lamps.begin(), s.lamps.end(), [](const LampConfig& lamp) { return lamp.lit; });
}

void judge_light(const ScenarioConfig& s, const SeenObject& o, const CameraReport& camera,
                 std::vector<std::string>& out) {
    if (o.place != SeenObject::Place::kVisible || o.holds_camera || any_lamp_lit(s)) return;
    const std::string name = "object '" + harmless(o.loaded.name) + "'";
    if (o.sunlit < kDark)
        out.push_back(fmt::format("{} is in eclipse: bodies leave it {:.2g} % of the Sun, and no lamp is lit",
                                  name, 100 * o.sunlit));
    else if (lit_share(o.phase_rad) < kDark)
        out.push_back(
            fmt::format("{} shows its night side: phase angle {:.1f} deg", name, degrees(o.phase_rad)));
    else if (o.expected.snr < 1)
        out.push_back(fmt::format("{} is lost in the noise: about {:.3g} e- of light, {:.3g} e- of noise",
                                  name, o.expected.signal_e, camera.sheet.dark_total_e));
    else if (o.expected.full_scale > 2 && !s.camera.auto_exposure.on)
        out.push_back(fmt::format(
            "{} saturates: about {:.3g} times what {} takes; {} is too high", name, o.expected.full_scale,
            camera.sheet.converter_e < camera.sheet.well_e ? "the converter" : "a pixel",
            camera.sheet.converter_e < camera.sheet.well_e ? "exposure_ms, or gain_dn_e with gain_db,"
                                                           : "exposure_ms"));
}

void judge_terrain(const ScenarioConfig& s, const FirstSight& sight, std::vector<std::string>& out) {
    if (!s.terrain) return;
    if (!sight.height_above_ground_m)
        out.push_back(
            "the camera is beside the terrain's map: terrain.place or pose, heights.spacing_m, or where the "
            "camera is");
    else if (*sight.height_above_ground_m < 0)
        out.push_back(fmt::format("the camera is {:.4g} m below the ground of the terrain",
                                  -*sight.height_above_ground_m));
}

// True when anything in the picture sends light.
bool shows_light(const ScenarioConfig& s, const FirstSight& sight) {
    if (sight.shows_sun || sight.shows_body || s.terrain || (s.stars && !s.stars->catalogue.empty()) ||
        any_lamp_lit(s) || models_of(s).radiance != "reflected")
        return true;
    return std::any_of(sight.objects.begin(), sight.objects.end(), [](const SeenObject& o) {
        return o.place == SeenObject::Place::kVisible && o.sunlit >= kDark && lit_share(o.phase_rad) >= kDark;
    });
}

}  // namespace

std::vector<std::string> judge(const ScenarioConfig& s, const CameraReport& camera) {
    std::vector<std::string> out;
    std::size_t left = 0;
    for (const SeenObject& o : camera.sight.objects) {
        std::vector<std::string> own;
        judge_place(o, camera, own);
        judge_light(s, o, camera, own);
        if (out.size() < kMaxTold)
            out.insert(out.end(), own.begin(), own.end());
        else
            left += own.empty() ? 0u : 1u;
    }
    if (left > 0)
        out.push_back(
            fmt::format("and {} more objects have warnings: --json tells where each of them is", left));
    if (!shows_light(s, camera.sight))
        out.push_back("nothing that is lit is in the picture: it will be black");
    for (std::string& line : judge_camera(camera.sheet, camera.period_s > 0)) out.push_back(std::move(line));
    judge_terrain(s, camera.sight, out);
    if (camera.share_in_bins < 0.5)
        out.push_back(
            fmt::format("spectrum_edges_um leave out {:.0f} % of what the camera would see of sunlight",
                        100 * (1 - camera.share_in_bins)));
    return out;
}

}  // namespace hilcam
