#pragma once
// A frame watcher wants to know what a loop has seen.

#include <cstdint>

#include "render/scene/scene.h"

namespace hilcam {

struct SeenFrame {
    std::uint64_t id = 0;       // 0: none yet
    std::int64_t begin_ns = 0;  // begin of the exposure, CLOCK_MONOTONIC; in lockstep as if that ran with it
    TimeTai middle;             // middle of the exposure, simulated
    double exposure_s = 0;
    bool dark = false;  // its shutter was closed: the world is that of a frame before, or none
};

class FrameWatcher {
  public:
    virtual ~FrameWatcher() = default;
    // A frame has been rendered; the world is that of its middle. Loop: no lock, no allocation.
    virtual void seen(const SeenFrame& frame, const WorldSnapshot& world) noexcept = 0;
};

}  // namespace hilcam
