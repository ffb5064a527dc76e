#pragma once
// Measures how long the camera's rays to bodies take, and what each part of the sky adds to it, as `hilcam check` tells it.

#include <optional>
#include <string>
#include <vector>

#include "render/shading/frame_context.h"

namespace hilcam {

// Returns the processor time of one frame's background [ms] over the tiles that each body of Background::disks() may be seen in, one
// thread, the shortest of three times, by a thousand tiles of a large one; empty where rays are not straight. Tiles of two bodies count for both. Nothing is
// counted that objects cover, as if there were none. The frame is placed. Not for the loop.
std::vector<double> sky_costs_ms(const FrameContext& frame);

// A part of how a body looks.
struct SkyPart {
    std::string body, text;  // "earth", "clouds: ..."
    // Time that the body's pixels would save without it, of one core; none: not in the picture, or not told.
    std::optional<double> ms;
    double resolved_ms = 0;  // less than this cannot be told from nothing
    std::size_t bytes = 0;
};
// Returns the parts of all bodies that have some, in the order of disks(). Each is measured against the same tiles without it,
// in turns, the shortest of three times a tile, by 256 tiles; the Earth's surface is what is left without its other
// parts. The same conditions.
std::vector<SkyPart> sky_parts(const FrameContext& frame);

}  // namespace hilcam
