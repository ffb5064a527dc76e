#pragma once
// Interface for observers of the world that a loop has seen.

#include <cstdint>

#include "render/scene/scene.h"

namespace hilcam {

struct SeenFrame {
    std::uint64_t id = 0;  // 0: none yet
    // Begin of the exposure, CLOCK_MONOTONIC; in lockstep, as if that clock ran with simulated time.
    std::int64_t begin_ns = 0;
    TimeTai middle;  // middle of the exposure in simulated time
    double exposure_s = 0;
    bool dark = false;  // true: the shutter was closed, so the world is an earlier frame's, or empty
};

class FrameWatcher {
  public:
    virtual ~FrameWatcher() = default;
    // Called when a frame has been rendered, with the world at its middle. Loop: no lock, no allocation.
    virtual void seen(const SeenFrame& frame, const WorldSnapshot& world) noexcept = 0;
};

}  // namespace hilcam
