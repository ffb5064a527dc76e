#pragma once
// Figures of a running loop: counters, and times of its stages. Both stages write them without a lock, and
// any thread may read them.

#include <array>
#include <atomic>
#include <cstdint>

#include "emulator/loop/latency.h"
#include "emulator/loop/missed_exposures.h"
#include "emulator/scenario/quality_ladder.h"

namespace hilcam {

// Time that each stage takes for a frame.
struct StageMeters {
    DurationHistogram setup, trace, stars, collapse, convolve, points, digitise, publish, render, sense;
    DurationHistogram work;      // render, sense and publish: a frame without its waits
    DurationHistogram interval;  // time between two frames handed over
    // From the arrival of the newest command that a frame is the first to show, until the frame is handed
    // over.
    DurationHistogram latency;

    // Called after warm-up.
    void clear() {
        for (DurationHistogram* meter : {&setup, &trace, &stars, &collapse, &convolve, &points, &digitise,
                                         &publish, &render, &sense, &work, &interval, &latency})
            meter->clear();
    }
};

struct LoopCounters {
    std::atomic<std::uint64_t> frames{0};
    // Exposures that were skipped, or triggered a period late, because the one before took too long.
    std::atomic<std::uint64_t> deadline_misses{0};
    std::atomic<std::uint64_t> last_id{0};
    std::atomic<std::int64_t> waited_for_outputs_ns{
        0};  // time during which a frame was ready but an output was not
    std::atomic<std::uint64_t> motion_limited{0};  // frames with more motion than exact motion can divide
    // Frames while time stood still; while poses were stale.
    std::atomic<std::uint64_t> standing{0}, stale{0};
    // Frames in which something had an impossible value (motion_bounds.h)
    std::atomic<std::uint64_t> impossible{0};
    // Frames made before the cached light that they need was ready: their number, and the newest of them.
    std::atomic<std::uint64_t> without_light{0}, last_without_light{0};
    std::atomic<bool> lacks_light{false};  // true: the newest frame is one of them
    // Quality levels: the newest frame's level, the number of changes, the number of frames at each level.
    std::atomic<std::uint32_t> level{0}, level_changes{0};
    std::array<std::atomic<std::uint64_t>, kMaxLevels> frames_at_level{};
    // Processor time of all threads, by the level of the frame published meanwhile.
    std::array<std::atomic<std::int64_t>, kMaxLevels> processor_ns_at_level{};
    std::array<std::atomic<std::uint64_t>, kMaxLevels> timed_frames_at_level{};
    std::atomic<double> budget_ms{0};  // budget of the newest frame; 0: no limit
};

struct LoopFigures {
    LoopCounters counters{};
    StageMeters meters{};
    MissedExposures missed{};
};

}  // namespace hilcam
