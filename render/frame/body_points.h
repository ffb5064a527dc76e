#pragma once
// Draws bodies of a few pixels or less as points. A body smaller than a pixel is one point. A larger one gets
// a small picture of its own with cells of half a pixel, each of which becomes a point at the centroid of its
// light. So the flux is that of the body at its phase, the light of a crescent is at the crescent, and
// nothing jumps from pixel to pixel.

#include <vector>

#include "render/shading/point_field.h"

namespace hilcam {

// The largest number of points for a body, and for Saturn with its rings, which are 2.3 times as wide.
inline constexpr std::size_t kMaxBodyPoints = 16 * 16, kMaxRingedPoints = 37 * 37;

// Appends the points of all bodies in the placed frame. Loop; no allocation while the vector has room.
void add_body_points(const FrameContext& frame, const PointField& field, std::vector<PointSource>& points);

}  // namespace hilcam
