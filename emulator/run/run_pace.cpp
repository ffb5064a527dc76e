#include "emulator/run/run_pace.h"

#include <spdlog/fmt/fmt.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <thread>

namespace hilcam {
namespace {

// This many frames at a level suffice to know its cost.
constexpr std::uint64_t kEnoughFrames = 30;

double core_ms_of(const LoopCounters& counters, std::size_t level) {
    return 1e-6 * static_cast<double>(counters.processor_ns_at_level[level].load());
}

// Returns the ratio of the frames' processor time to the cost measured before the run; nothing if no level
// has both.
std::optional<double> load_of(const LoopCounters& counters, const std::vector<LevelCost>& costs) {
    double took_ms = 0, cost_ms = 0;
    for (std::size_t level = 0; level < std::min(costs.size(), kMaxLevels); ++level) {
        if (!(costs[level].core_ms > 0)) continue;
        took_ms += core_ms_of(counters, level);
        cost_ms += costs[level].core_ms * static_cast<double>(counters.timed_frames_at_level[level].load());
    }
    return cost_ms > 0 ? std::optional(took_ms / cost_ms) : std::nullopt;
}

PaceLimit cause_of_frames(const CameraStation& station) {
    if (station.scenario().mode == CameraMode::kLockstep) return PaceLimit::kCommands;
    return station.settings().settings().triggered ? PaceLimit::kTriggers : PaceLimit::kFrameRate;
}

std::string levels_text(const LoopCounters& counters) {
    std::string out;
    for (std::size_t level = 0; level < kMaxLevels; ++level)
        if (const std::uint64_t frames = counters.frames_at_level[level].load(); frames > 0)
            out += fmt::format("{}{} frames at level {}", out.empty() ? "" : ", ", frames, level);
    return out;
}

}  // namespace

std::optional<double> full_quality_core_ms(const LoopCounters& counters,
                                           const std::vector<LevelCost>& level_costs) {
    const std::uint64_t frames = counters.timed_frames_at_level[0].load();
    if (frames >= kEnoughFrames) return core_ms_of(counters, 0) / static_cast<double>(frames);
    if (level_costs.empty() || !(level_costs[0].core_ms > 0)) return {};
    return level_costs[0].core_ms * load_of(counters, level_costs).value_or(1);
}

std::optional<FullQuality> full_quality(const CameraStation& station) {
    if (cause_of_frames(station) != PaceLimit::kFrameRate) return {};
    const auto core_ms = full_quality_core_ms(station.loop().counters(), station.level_costs());
    return core_ms ? std::optional(FullQuality{*core_ms, 1 / station.period_s()}) : std::nullopt;
}

std::string_view words_of(PaceLimit limit) {
    constexpr std::array<std::string_view, 6> kWords = {"commands",  "triggers", "the camera's frame rate",
                                                        "rendering", "sensor",   "outputs"};
    return kWords[static_cast<std::size_t>(limit)];
}

PaceLimit pace_limit(const Misses& misses, const StageMeters& meters, PaceLimit cause) {
    constexpr std::uint64_t kOneOf = 50;  // exposures
    if (cause == PaceLimit::kCommands || misses.missed * kOneOf <= misses.frames + misses.missed)
        return cause;
    const double render_ms = meters.render.quantile_ms(0.5), sense_ms = meters.sense.quantile_ms(0.5),
                 publish_ms = meters.publish.quantile_ms(0.5);
    if (render_ms >= sense_ms + publish_ms) return PaceLimit::kRendering;
    return sense_ms >= publish_ms ? PaceLimit::kSensor : PaceLimit::kOutputs;
}

PaceLimit pace_limit(const CameraStation& station, const Misses& misses) {
    return pace_limit(misses, station.loop().meters(), cause_of_frames(station));
}

int given_cores() {
    const std::size_t threads =
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    return static_cast<int>(
        std::min<std::size_t>(threads, std::max(1u, std::thread::hardware_concurrency())));
}

std::string quality_line(const CameraStation& station) {
    const LoopCounters& counters = station.loop().counters();
    const std::uint64_t frames = counters.frames.load(), best = counters.frames_at_level[0].load();
    const std::optional<FullQuality> full = full_quality(station);
    std::string out;
    if (best < frames) out = levels_text(counters) + " (0: full quality)";
    const bool lacks = best < frames || pace_limit(station, {frames, counters.deadline_misses.load()}) >=
                                            PaceLimit::kRendering;
    if (!full || !lacks) return out;
    out += fmt::format(
        "{}full quality takes {:.0f} core-ms a frame, {:.1f} cores at {:.4g} frames/s, and the machine gives "
        "{}",
        out.empty() ? "" : "; ", full->core_ms, full->cores(), full->rate_hz, given_cores());
    return best < frames ? out + "; loop.levels: fixed keeps it at fewer frames/s" : out;
}

}  // namespace hilcam
