#pragma once
// Measures, before a run opens its outputs, what a frame costs at each quality level. The governor then
// begins at a level that holds the camera's rate (emulator/loop/governor.h), and the run can report what full
// quality would need.

#include <functional>
#include <vector>

#include "emulator/run/trial_frames.h"

namespace hilcam {

// The machine and setup for which frames are made.
struct FrameMachine {
    int threads = 1;          // threads for rendering and sensing
    std::size_t cameras = 1;  // cameras that share the threads
    LoopPreference prefer = LoopPreference::kThroughput;
};

// Returns how long a frame of that cost keeps the next one waiting [ms]. With throughput that is the longer
// of the two stages, if there are enough threads for both at once.
double frame_ms(const TrialCost& cost, const FrameMachine& machine);

// Cost of a frame at a level. frame_ms: 0: not measured, infinity: too long to measure.
struct LevelCost {
    double frame_ms = 0, core_ms = 0;
};

// Measures levels from the best one down to the first with frames that take no longer than enough_ms. Levels
// below that, and levels of which a frame takes a minute, are not measured. take: makes a frame at a level.
// rays: number of primary rays of a frame at each level.
std::vector<LevelCost> measure_levels(const std::vector<double>& rays, double enough_ms,
                                      const FrameMachine& machine,
                                      const std::function<TrialCost(std::size_t level)>& take);

}  // namespace hilcam
