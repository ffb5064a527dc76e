#pragma once
// Finds, before a run opens its outputs, what a frame of each quality level costs: the governor begins at the level that
// holds the camera's rate (emulator/loop/governor.h), and the run can say what full quality would need.

#include <functional>
#include <vector>

#include "emulator/run/trial_frames.h"

namespace hilcam {

// The machine that frames are made on.
struct FrameMachine {
    int threads = 1;          // that render and sense
    std::size_t cameras = 1;  // that share the threads
    LoopPreference prefer = LoopPreference::kThroughput;
};

// Returns how long a frame of that cost keeps the next one waiting [ms]: with throughput the longer of the two stages, as far
// as the threads suffice for both at once.
double frame_ms(const TrialCost& cost, const FrameMachine& machine);

// The cost of a frame at each level; frame_ms: 0: not measured, infinity: too long to be.
struct LevelCost {
    double frame_ms = 0, core_ms = 0;
};

// Measures levels from the best down to the first one whose frames take no longer than enough_ms; those below are not
// measured, nor is a level that takes a minute. take: makes a frame of a level. rays: the primary rays of each level's
// frames.
std::vector<LevelCost> measure_levels(const std::vector<double>& rays, double enough_ms,
                                      const FrameMachine& machine,
                                      const std::function<TrialCost(std::size_t level)>& take);

}  // namespace hilcam
