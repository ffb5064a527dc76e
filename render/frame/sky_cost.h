#pragma once
// Measures how long the camera's rays to bodies take, as `hilcam check` tells it.

#include <vector>

#include "render/light/frame_view.h"

namespace hilcam {

// Returns the processor time of one frame's background [ms] over the tiles that each body of Background::disks() may be seen in, one
// thread, the shortest of three times, by a thousand tiles of a large one; empty where rays are not straight. Tiles of two bodies count for both. Nothing is
// counted that objects cover, as if there were none. The frame is placed. Not for the loop.
std::vector<double> sky_costs_ms(const FrameView& frame);

}  // namespace hilcam
