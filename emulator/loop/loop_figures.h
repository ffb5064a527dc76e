#pragma once
// The figures that a loop tells of itself while it runs: counters and times of its stages. Both stages write them without
// a lock, and any thread may read them.

#include <array>
#include <atomic>
#include <cstdint>

#include "emulator/loop/latency.h"
#include "emulator/scenario/quality_ladder.h"

namespace hilcam {

// The time that each stage took, per frame.
struct StageMeters {
    DurationHistogram setup, trace, stars, collapse, convolve, points, digitise, publish, render, sense;
    DurationHistogram work;      // render, sense and publish: the frame without its waits
    DurationHistogram interval;  // from one frame handed over to the next
    // Time from the arrival of the newest command that a frame is the first to show to the frame handed over.
    DurationHistogram latency;

    // Is called after warming up.
    void clear() {
        for (DurationHistogram* meter : {&setup, &trace, &stars, &collapse, &convolve, &points, &digitise,
                                         &publish, &render, &sense, &work, &interval, &latency})
            meter->clear();
    }
};

struct LoopCounters {
    std::atomic<std::uint64_t> frames{0};
    // Exposures skipped, or of a trigger begun a period late, because the one before took too long.
    std::atomic<std::uint64_t> deadline_misses{0};
    std::atomic<std::uint64_t> last_id{0};
    std::atomic<std::int64_t> waited_for_outputs_ns{
        0};                                        // time in which a frame was ready and an output was not
    std::atomic<std::uint64_t> motion_limited{0};  // frames with more motion than exact motion divides
    std::atomic<std::uint64_t> standing{0}, stale{0};  // frames while time stood; while no poses came
    std::atomic<std::uint64_t> impossible{0};  // frames in which something could not be (motion_bounds.h)
    // Frames before the cached light that they ask for was there: how many, and the newest one.
    std::atomic<std::uint64_t> without_light{0}, last_without_light{0};
    std::atomic<bool> lacks_light{false};  // the newest frame is one
    // Quality levels: that of the newest frame, how often it changed, how many frames each has had.
    std::atomic<std::uint32_t> level{0}, level_changes{0};
    std::array<std::atomic<std::uint64_t>, kMaxLevels> frames_at_level{};
    // Processor time of all threads while frames of each level were published.
    std::array<std::atomic<std::int64_t>, kMaxLevels> processor_ns_at_level{};
    std::array<std::atomic<std::uint64_t>, kMaxLevels> timed_frames_at_level{};
    std::atomic<double> budget_ms{0};  // budget of the newest frame; 0: it might take as long as it liked
};

struct LoopFigures {
    LoopCounters counters;
    StageMeters meters;
};

}  // namespace hilcam
