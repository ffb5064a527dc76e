#pragma once
// Measurements of the renderer for `hilcam bench`: bare Embree on a frame's own rays, and path models against
// it. Not for the loop.

#include <cstdint>
#include <string>
#include <vector>

#include "render/frame/frame_setup.h"
#include "render/frame/frame_tracer.h"

namespace hilcam {

// The speed of a path model against Embree alone on the same rays.
struct PathModelSpeed {
    std::string name;
    std::uint64_t rays = 0;  // number of rays of all kinds in one frame
    double frame_ms = 0;
    double bare_ms = 0;  // Embree alone
};

// Time that bare Embree needs for the primary and shadow rays that the placed frame traces, the same packets
// on the same threads with nothing around them [ms]: the floor that no renderer built on it can go below.
double bare_rays_ms(FrameSetup& setup, FrameTracer& tracer);

// The placed frame with every path model of the registry, medians of `runs`.
std::vector<PathModelSpeed> path_model_speeds(FrameSetup& setup, FrameTracer& tracer, const Modules& modules,
                                              int runs);

}  // namespace hilcam
