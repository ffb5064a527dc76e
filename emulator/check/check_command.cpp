#include "emulator/check/check_command.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>

#include "emulator/check/camera_judge.h"
#include "emulator/check/camera_sheet.h"
#include "emulator/check/scenario_verdict.h"
#include "emulator/loop/exposure_renderer.h"
#include "emulator/loop/shutter_timing.h"
#include "emulator/run/camera_station.h"
#include "emulator/scenario/initial_world.h"
#include "emulator/scenario/lamp_setup.h"
#include "emulator/scenario/motion_builder.h"
#include "emulator/scenario/scenario_warnings.h"
#include "emulator/scenario/scene_loader.h"
#include "emulator/world/clock.h"
#include "io/config/config_yaml.h"
#include "io/system/resident_memory.h"

namespace hilcam {
namespace {

// Says how the exposure of the first instant will be made, and why.
std::string motion_line(const ScenarioConfig& s, WorldState& world, ExposureRenderer& exposures) {
    const double exposure_s = ShutterTiming(s.camera).exposure_s(s.camera.exposure_s);
    const ExposureRenderer::Plan plan = exposures.plan(world, parse_utc(s.time_utc), exposure_s);
    const char* names[] = {"off", "fast", "exact"};
    std::string out = fmt::format(
        "motion {}: the picture moves by {:.3g} px in {:.4g} ms, anything in it by {:.3g} px at most",
        names[static_cast<std::size_t>(s.quality.motion)], plan.picture_px, exposure_s * 1e3,
        plan.largest_px);
    if (s.quality.motion == MotionQuality::kExact)
        out += fmt::format("; {} parts{}", plan.parts,
                           plan.parts_limited ? " (the most possible; more were requested)" : "");
    if (s.quality.motion == MotionQuality::kExact && s.camera.shutter.kind == ShutterKind::kLineScan)
        out += " (a scanning line sees each place when it passes: as fast)";
    return out;
}

// Says where the transfer tables came from, how long that took here, and what a run does without them.
std::string light_line(const ScenarioConfig& s, const LightLoading& light) {
    if (light.found + light.made == 0) return {};
    if (light.made == 0)
        return fmt::format("tables of directions: {} on disk, read in {:.2g} s: runs start with cached light",
                           light.found, light.seconds);
    std::string out =
        fmt::format("tables of directions: {} made in {:.3g} s and kept on disk", light.made, light.seconds);
    if (light.found > 0) out += fmt::format(" as {} were", light.found);
    const bool waits = s.mode == CameraMode::kLockstep || s.loop.wait_for_light;
    return out + (waits ? "; a run waits for missing ones"
                        : "; a run without them starts with random paths and makes them meanwhile "
                          "(loop.wait_for_light)");
}

// Says what has to be computed for the truth of frames, and why.
std::string truth_line(const ScenarioConfig& s) {
    const auto* truth = s.outputs.find<TruthConfig>();
    if (!truth) return {};
    const TruthRequest request = request_of(*truth);
    std::string out = "truth: poses and places";
    if (request.rays())
        out += fmt::format(
            "; a ray for each pixel that can meet something ({}{}{})", request.visibility ? "visibility" : "",
            request.visibility && request.layers() ? ", " : "", request.layers() ? "layers" : "");
    if (request.stars) out += "; stars in view";
    return out;
}

// Says how light from outside the picture becomes glare, how much of it there is, and how long it takes to
// compute.
std::string outside_line(const ScenarioConfig& s, ExposureRenderer& exposures) {
    if (!s.camera.outside_light) return {};
    std::vector<SideLight> lights;
    const std::int64_t start_ns = monotonic_ns();
    exposures.look_beside(lights);
    const double ms = static_cast<double>(monotonic_ns() - start_ns) * 1e-6;
    const OutsideLightConfig& outside = *s.camera.outside_light;
    return fmt::format(
        "light from beside the picture: {} directions of the Sun and bodies, found in {:.2g} ms; glare by "
        "{}, {} ghosts",
        lights.size(), ms,
        !outside.transmittance.empty() ? "the measured transmittance"
        : outside.baffle_rad > 0       ? "the lens's halo and wings, behind a baffle"
                                       : "the lens's halo and wings",
        outside.ghosts.size());
}

std::string seed_line(const ScenarioConfig& s) {
    if (!s.has_seed) return "seed: none, so each run draws its own noise, and reports its seed";
    return fmt::format("seed: {}, so every run has the same noise in the same frame", s.seed);
}

std::string loop_line(const ScenarioConfig& s) {
    const RealTime& w = s.loop.real_time;
    std::string out = s.loop.prefer == LoopPreference::kLatency
                          ? "loop: one frame at a time, each with all threads"
                          : "loop: a frame is rendered while the previous one is in the sensor";
    if (w.priority > 0) out += fmt::format("; real-time priority {}", w.priority);
    if (!w.cores.empty()) out += fmt::format("; on cores {}", fmt::join(w.cores, ", "));
    if (w.lock_memory) out += "; memory locked";
    return out;
}

// Says which levels the governor may choose, or why there is none.
std::vector<std::string> governor_lines(ScenarioConfig s) {
    s.loop.holds_rate = true;
    const std::string off = governor_off(s);
    if (!off.empty()) return {"governor off (" + off + ")"};
    const ShutterTiming timing(s.camera);
    const bool of_rate = s.loop.budget_is_of_rate();
    const double budget_s =
        of_rate
            ? timing.period_s(s.camera.frame_rate_hz, timing.exposure_s(s.camera.exposure_s)) / s.clock.scale
            : s.loop.frame_budget_s;
    std::vector<std::string> out = {
        fmt::format("governor: {} may take {:.4g} ms{}; quality level 0 is as configured",
                    s.loop.prefer == LoopPreference::kLatency ? "a frame" : "each of a frame's two stages",
                    1e3 * budget_s, of_rate ? ", until the next exposure is due" : "")};
    RenderQuality last = render_quality_of(s);
    int number = 0;
    for (const RenderQuality& level : lower_levels(s)) {
        const std::string what = difference(last, level);
        out.push_back(fmt::format("  level {}: {}", ++number, what.empty() ? "as the one before" : what));
        last = level;
    }
    return out;
}

// Makes everything of a camera that a run makes before it opens ports and devices, in the same way, so that
// its errors show. Temporary faults of the machine are only warnings: the interface of GigE Vision, and used
// folders.
std::unique_ptr<CameraStation> make_station(const ScenarioConfig& s, std::size_t index,
                                            const SpectralGrid& grid) {
    ScenarioConfig own = scenario_of_camera(s, index);
    own.outputs.give<GigeConfig>(false);
    own.outputs.for_each([](auto& output, bool) {
        if constexpr (requires { output.overwrite; }) output.overwrite = true;
    });
    auto station = std::make_unique<CameraStation>(own, index + 1, RunLimits{});
    station->load(grid);
    return station;
}

// memory_mb: receives the memory of the process while the camera is loaded.
CameraReport report_of(const ScenarioConfig& bench, std::size_t index, const SpectralGrid& grid,
                       const Pose& first_camera, std::vector<std::string>& about_objects, double& memory_mb) {
    const ScenarioConfig s = scenario_of_camera(bench, index);
    const std::unique_ptr<CameraStation> station = make_station(bench, index, grid);
    const TimeTai time = parse_utc(s.time_utc);
    const LoadedView view{s, station->renderer(), station->objects()};
    std::vector<std::string> plan = station->renderer().explain_plan(snapshot_at(s, time, time));
    CameraReport report = report_view(view, index + 1, first_camera);
    report.plan = std::move(plan);
    WorldState world(initial_motions(s, time), s.origin, joints_of(s), s.mount, load_motion_sources(s),
                     lamp_mounts(s));
    ExposureRenderer exposures(station->renderer(), exposure_config_of(s), s.camera, grid,
                               world.placed_objects());
    report.frame_time = frame_time(*station, world, exposures);
    if (const std::string light = light_line(s, station->light()); !light.empty())
        report.plan.push_back(light);
    if (const std::string outside = outside_line(s, exposures); !outside.empty())
        report.plan.push_back(outside);
    if (const std::optional<StrayTime> stray = stray_time(*station, world, exposures))
        report.plan.push_back(
            fmt::format("stray light of the lens ({}): takes {:.2g} ms of the sensor's time", stray->parts,
                        std::max(stray->ms, stray->resolved_ms)) +
            (stray->ms < stray->resolved_ms ? " at most" : ""));
    report.plan.push_back(motion_line(s, world, exposures));
    if (const std::string truth = truth_line(s); !truth.empty()) report.plan.push_back(truth);
    if (about_objects.empty()) about_objects = verdict_on_objects(view, VerdictOn::kAll);
    memory_mb = ResidentMemory().megabytes();
    return report;
}

}  // namespace

bool is_camera_file(const std::filesystem::path& file) { return has_top_level_key(file, "pitch_um"); }

Checked check_camera(const std::filesystem::path& file, std::span<const std::string> overrides, bool json) {
    CameraModel camera;
    KeyPlaces places(file.string(), "camera.");
    read_config(file, section_of(camera), overrides, &places);
    draw_fixed_pattern(camera, load_detector_pictures(camera));  // throws when a map does not fit
    const CameraSheet sheet = camera_sheet(camera);
    const std::vector<std::string> warnings = judge_camera(sheet, true, places);
    std::string text;
    for (const std::string& line : warnings) text += "warning: " + line + "\n";
    return {json ? to_json(sheet, warnings) : text + to_text(sheet), !warnings.empty()};
}

CheckReport check_scenario(const ScenarioConfig& s, std::size_t camera) {
    const SpectralGrid grid(s.spectrum_edges_um);
    CheckReport out;
    out.scenario = s.name;
    out.time = parse_utc(s.time_utc);
    out.cameras = 1 + s.more_cameras.size();
    out.warnings = early_verdict(s, VerdictOn::kAll);
    const auto warn = [&](const std::vector<std::string>& lines) {
        out.warnings.insert(out.warnings.end(), lines.begin(), lines.end());
    };
    const Pose first_camera = snapshot_at(s, out.time, out.time).camera;
    std::vector<std::string> about_objects;  // the same for every camera
    // One camera after the other, because each scene is large.
    for (std::size_t i = 0; i < out.cameras; ++i) {
        if (camera != 0 && camera != i + 1) continue;
        double memory_mb = 0;
        out.reports.push_back(report_of(s, i, grid, first_camera, about_objects, memory_mb));
        out.memory_mb = std::max(out.memory_mb, memory_mb);
        warn(verdict_on_view(scenario_of_camera(s, i), out.reports.back()));
    }
    warn(about_objects);
    MapReport maps = report_scenario_maps(s);
    warn(maps.doubts);
    out.maps = std::move(maps.taken);
    out.run = {seed_line(s), loop_line(s)};
    for (std::string& line : no_output_warnings(s)) out.run.push_back(std::move(line));
    for (std::string& line : governor_lines(s)) out.run.push_back(std::move(line));
    return out;
}

}  // namespace hilcam
