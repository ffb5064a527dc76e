#include "emulator/check/check_command.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include "emulator/check/camera_sheet.h"
#include "emulator/loop/exposure_renderer.h"
#include "emulator/loop/shutter_timing.h"
#include "emulator/run/camera_station.h"
#include "emulator/scenario/initial_world.h"
#include "emulator/scenario/lamp_setup.h"
#include "emulator/scenario/motion_builder.h"
#include "emulator/scenario/scene_loader.h"
#include "io/config/config_yaml.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// How the exposure of the first instant will be made, and why.
std::string motion_line(const ScenarioConfig& s, Renderer& renderer, const SpectralGrid& grid) {
    const TimeTai start = parse_utc(s.time_utc);
    WorldState world(initial_motions(s, start), s.origin, joints_of(s), s.mount, load_motion_sources(s),
                     lamp_mounts(s));
    ExposureRenderer exposures(renderer, s, grid, world.placed_objects());
    const double exposure_s = ShutterTiming(s.camera).exposure_s(s.camera.exposure_s);
    const ExposureRenderer::Plan plan = exposures.plan(world, start, exposure_s);
    const char* names[] = {"off", "fast", "exact"};
    std::string out = fmt::format(
        "motion {}: the picture moves by {:.3g} px in {:.4g} ms, anything in it by {:.3g} px at most",
        names[static_cast<std::size_t>(s.quality.motion)], plan.picture_px, exposure_s * 1e3,
        plan.largest_px);
    if (s.quality.motion == MotionQuality::kExact)
        out += fmt::format("; {} parts{}", plan.parts,
                           plan.parts_limited ? " (the most there are; more asked for)" : "");
    if (s.quality.motion == MotionQuality::kExact && s.camera.shutter.kind == ShutterKind::kLineScan)
        out += " (a scanning line sees each place when it passes: as fast)";
    return out;
}

// What telling the truth of frames computes, and why.
std::string truth_line(const ScenarioConfig& s) {
    if (!s.outputs.has_truth) return {};
    const TruthWishes wishes = wishes_of(s.outputs.truth);
    std::string out = "truth: poses and places";
    if (wishes.rays())
        out += fmt::format("; a ray for each pixel that can meet something ({}{}{})",
                           wishes.visibility ? "visibility" : "",
                           wishes.visibility && wishes.layers() ? ", " : "", wishes.layers() ? "layers" : "");
    if (wishes.stars) out += "; stars in view";
    return "  " + out + "\n";
}

std::string seed_line(const ScenarioConfig& s) {
    if (!s.has_seed) return "seed: none, so each run draws its own noise, and says its seed\n";
    return fmt::format("seed: {}, so every run has the same noise in the same frame\n", s.seed);
}

std::string loop_line(const ScenarioConfig& s) {
    const RealTime& w = s.loop.real_time;
    std::string out = s.loop.prefer == LoopPreference::kLatency
                          ? "loop: one frame at a time, each with all threads"
                          : "loop: a frame is rendered while the one before is sensed";
    if (w.priority > 0) out += fmt::format("; real-time priority {}", w.priority);
    if (!w.cores.empty()) out += fmt::format("; on cores {}", fmt::join(w.cores, ", "));
    if (w.lock_memory) out += "; memory locked";
    return out + "\n";
}

// Which levels the governor may choose, or why there is none.
std::string governor_lines(const ScenarioConfig& s) {
    const std::string off = governor_off(s);
    if (!off.empty()) return "governor off (" + off + ")\n";
    std::string out =
        fmt::format("governor: {} may take {:.4g} ms; quality level 0 is as configured\n",
                    s.loop.prefer == LoopPreference::kLatency ? "a frame" : "each of a frame's two stages",
                    1e3 * s.loop.frame_budget_s);
    RenderQuality last = render_quality_of(s);
    int number = 0;
    for (const RenderQuality& level : lower_levels(s)) {
        const std::string what = difference(last, level);
        out += fmt::format("  level {}: {}\n", ++number, what.empty() ? "as the one before" : what);
        last = level;
    }
    return out;
}

// Makes of a camera what a run makes before it opens ports and devices, and as a run makes it: what is wrong
// with any of it is said. GigE Vision's interface is the machine's, not the scenario's: `hilcam doctor` and
// the run look for it.
std::unique_ptr<CameraStation> make_station(const ScenarioConfig& s, std::size_t index,
                                            const SpectralGrid& grid) {
    ScenarioConfig own = scenario_of_camera(s, index);
    own.outputs.has_gige = false;
    auto station = std::make_unique<CameraStation>(own, index + 1, RunLimits{});
    station->load(grid);
    return station;
}

}  // namespace

bool is_camera_file(const std::filesystem::path& file) { return has_top_level_key(file, "pitch_um"); }

std::string check_camera(const std::filesystem::path& file, std::span<const std::string> overrides) {
    CameraModel camera;
    read_config(file, section_of(camera), overrides);
    draw_fixed_pattern(camera, load_detector_pictures(camera));  // throws when a map does not fit
    return to_text(camera_sheet(camera));
}

std::string check_scenario(const ScenarioConfig& s) {
    const SpectralGrid grid(s.spectrum_edges_um);
    const TimeTai time = parse_utc(s.time_utc);
    // One after the other: the scene of each is large.
    for (std::size_t i = s.more_cameras.size(); i > 0; --i) make_station(s, i, grid);
    const std::unique_ptr<CameraStation> first = make_station(s, 0, grid);
    Renderer& renderer = first->renderer();
    const WorldSnapshot world = snapshot_at(s, time, time);
    std::string out = to_text(camera_sheet(s.camera)) +
                      fmt::format(
                          "scenario {} at {}\n  its bins have {:.1f} % of the camera's photo-electrons of "
                          "sunlight\nplan\n",
                          harmless(s.name), format_utc(time), 100 * share_in_bins(s.camera, grid));
    for (const std::string& line : renderer.explain_plan(world)) out += "  " + harmless(line) + "\n";
    return out + "  " + motion_line(s, renderer, grid) + "\n" + truth_line(s) + seed_line(s) + loop_line(s) +
           governor_lines(s);
}

}  // namespace hilcam
