#pragma once
// Measurements for `hilcam bench`: Embree alone on a frame's own rays, and path models compared with it. Not
// for the loop.

#include <cstdint>
#include <string>
#include <vector>

#include "render/frame/frame_setup.h"
#include "render/frame/frame_tracer.h"

namespace hilcam {

// The speed of a path model, and of Embree alone on the same rays.
struct PathModelSpeed {
    std::string name;
    std::uint64_t rays = 0;  // rays of all kinds in one frame
    double frame_ms = 0;
    double bare_ms = 0;  // Embree alone
};

// Returns the time [ms] that Embree alone needs for the primary and shadow rays of the placed frame, by the
// same packets on the same threads. No renderer built on Embree can be faster.
double bare_rays_ms(FrameSetup& setup, FrameTracer& tracer);

// Renders the placed frame with every path model of the registry; times are medians of `runs`.
std::vector<PathModelSpeed> path_model_speeds(FrameSetup& setup, FrameTracer& tracer, const Modules& modules,
                                              int runs);

}  // namespace hilcam
