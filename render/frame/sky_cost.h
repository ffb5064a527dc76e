#pragma once
// Measures the time of the camera's rays to bodies and the share of each part of the sky, for `hilcam check`.

#include <optional>
#include <string>
#include <vector>

#include "render/shading/frame_context.h"

namespace hilcam {

// Returns the processor time [ms] of one frame's background, in the tiles that may show each body of
// Background::disks(): one thread, the shortest of three runs, estimated from a thousand tiles of a large
// body. Empty if rays are not straight. Tiles that show two bodies count for both, and tiles covered by
// objects count as if they were not. The frame is placed. Not for the loop.
std::vector<double> sky_costs_ms(const FrameContext& frame);

// A part of a body's look.
struct SkyPart {
    std::string body, text;  // "earth", "clouds: ..."
    // Time on one core that the body's pixels would save without this part; none: not in the picture, or not
    // measured.
    std::optional<double> ms;
    double resolved_ms = 0;  // smaller times cannot be told from zero
    std::size_t bytes = 0;
};
// Returns the parts of all bodies that have parts, in the order of disks(). Each is measured against the same
// tiles without it, in turns: the shortest of three runs per tile, from 256 tiles. The Earth's surface is
// what remains without its other parts. Conditions as for sky_costs_ms().
std::vector<SkyPart> sky_parts(const FrameContext& frame);

}  // namespace hilcam
