#include "emulator/check/scenario_verdict.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <iterator>

#include "emulator/check/machine_verdict.h"
#include "emulator/check/mesh_survey.h"
#include "emulator/loop/shutter_timing.h"
#include "emulator/scenario/loaded_for.h"
#include "emulator/scenario/motion_builder.h"
#include "emulator/scenario/scenario_warnings.h"
#include "emulator/scenario/scene_loader.h"
#include "io/files/catalogue_file.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

using Lines = std::vector<std::string>;

void append(Lines more, Lines& out) { std::move(more.begin(), more.end(), std::back_inserter(out)); }

// `check` examines meshes of any size; `render` and `run` do not wait for millions of edges to be sorted.
constexpr std::size_t kMaxTrianglesOnTheWay = 50'000;

// Selects from the findings of `hilcam mesh` those that make a mesh look wrong; panels are open on purpose.
Lines mesh_warnings(const ObjectConfig& object, const std::string& key, const KeyPlaces& places) {
    const std::optional<int> surface =
        object.has_mesh_surface ? std::optional<int>(static_cast<int>(object.mesh_surface)) : std::nullopt;
    const MeshSurvey survey = survey_mesh(load_mesh_contents(object.mesh, surface), object.mesh.string());
    Lines out;
    const std::string name = key + ": '" + harmless(object.mesh.filename().string()) + "'";
    if (survey.inverted_shells > 0)
        out.push_back(
            places.at(key, fmt::format("{} is inside out: the triangles of {} of its {} closed surfaces face "
                                       "inwards ('hilcam mesh' lists them); reverse their vertex order",
                                       name, survey.inverted_shells, survey.shells)));
    for (const std::string& file : survey.missing_materials)
        out.push_back(places.at(key, name + " names the materials " + in_quotes(file) +
                                         ", and there is no such file: its surfaces are grey"));
    for (const std::string& remark : survey.remarks) out.push_back(places.at(key, name + ": " + remark));
    return out;
}

// Returns a warning of stars that have no certain colour in the catalogue: V-I is 1.7 (M0) to 2.9 (M5) for
// giants of B-V 1.6, and 1.9 to 2.8 for dwarfs of B-V 1.5.
Lines star_warnings(const ScenarioConfig& s) {
    if (!s.stars || s.stars->catalogue.empty()) return {};
    const StarCatalogue catalogue =
        loaded_for(s.stars->catalogue_where, [&] { return load_catalogue(s.stars->catalogue); });
    if (catalogue.tells_red_stars) return {};
    constexpr double kTellsLittle_mag = 1.5;
    const auto red =
        std::count_if(catalogue.stars.begin(), catalogue.stars.end(), [&](const CatalogueStar& star) {
            return star.color_b_v > kTellsLittle_mag && star.magnitude_v <= s.stars->faintest_magnitude;
        });
    if (red == 0) return {};
    return {s.places.at(
        "stars.catalogue",
        fmt::format("{} of its stars have a B-V above 1.5, which is inaccurate for M stars: in the red they "
                    "are up to 0.8 mag off; a column v_i or spectral_type prevents it",
                    red))};
}

}  // namespace

std::vector<std::string> early_verdict(const ScenarioConfig& bench, VerdictOn on, bool keeps_frames) {
    Lines out = bench.warnings;
    if (on != VerdictOn::kPicture) append(idle_run_warnings(bench), out);
    if (on == VerdictOn::kRun && !keeps_frames) append(no_output_warnings(bench), out);
    append(idle_warnings(bench), out);
    append(length_warnings(bench), out);
    append(place_warnings(bench), out);
    append(motion_warnings(bench), out);
    if (on != VerdictOn::kAll) return out;
    append(star_warnings(bench), out);
    for (std::size_t i = 0; i <= bench.more_cameras.size(); ++i)
        append(machine_warnings(scenario_of_camera(bench, i)), out);
    return out;
}

std::vector<std::string> verdict_on_objects(const LoadedView& view, VerdictOn on) {
    const KeyPlaces places = view.scenario.places.labelled("");  // objects belong to all cameras
    Lines out = warnings_of(view.objects, places);
    for (std::size_t i = 0; i < view.objects.size(); ++i) {
        const ObjectConfig& object = view.scenario.objects[i];
        if (!object.has_mesh || (on != VerdictOn::kAll && view.objects[i].triangles > kMaxTrianglesOnTheWay))
            continue;
        const auto same = [&](const ObjectConfig& before) { return before.mesh == object.mesh; };
        const auto here = view.scenario.objects.begin() + static_cast<std::ptrdiff_t>(i);
        if (std::any_of(view.scenario.objects.begin(), here, same)) continue;
        append(mesh_warnings(object, fmt::format("objects.{}.mesh", i), places), out);
    }
    return out;
}

MapReport report_scenario_maps(const ScenarioConfig& s) {
    MapReport out;
    if (s.terrain && s.terrain->globe) out = report_maps(*s.terrain->globe, ground_body(s));
    const auto add = [&](const std::string& name, const Figure& figure, const BodyConfig& body) {
        const bool flat = figure.polar_radius_m != figure.equatorial_radius_m;
        if (!flat || body.albedo_map.empty() || !body.visible) return;
        const bool centric = body.albedo_map_latitudes == MapLatitude::kPlanetocentric;
        out.taken.push_back(fmt::format("{}.albedo_map: {}: latitudes {} ({}.albedo_map_latitudes)", name,
                                        harmless(body.albedo_map.string()),
                                        centric ? "planetocentric" : "planetographic", name));
    };
    for (std::size_t i = 0; i < kBodyCount; ++i) add(std::string(kBodyNames[i]), kFigures[i], s.bodies[i]);
    for (std::size_t k = 0; k < s.own_bodies.size(); ++k)
        add(s.own_bodies[k].name, s.origin.own->list[k].figure, s.own_bodies[k].look);
    return out;
}

CameraReport report_view(const LoadedView& view, std::size_t number, const Pose& first_camera) {
    const ScenarioConfig& s = view.scenario;
    CameraReport report;
    report.number = number;
    report.sheet = camera_sheet(s.camera);
    report.share_in_bins = share_in_bins(s.camera, SpectralGrid(s.spectrum_edges_um));
    report.sight = first_sight(s, view.renderer, view.objects, report.sheet, first_camera);
    if (s.mode == CameraMode::kFreeRun)
        report.period_s = ShutterTiming(s.camera).period_s(s.camera.frame_rate_hz, report.sheet.exposure_s);
    return report;
}

}  // namespace hilcam
