#pragma once
// The light of bodies that are a few pixels wide or less, as points: of a body below a pixel one, of a larger one its own
// little picture in cells of half a pixel, each a point at the middle of its light. So the light is the body's at its phase,
// a crescent's lies where the crescent is, and its place does not jump from pixel to pixel.

#include <vector>

#include "render/shading/point_field.h"

namespace hilcam {

// Greatest number of points of a body, and of Saturn with its rings, which are 2.3 times as wide.
inline constexpr std::size_t kMaxBodyPoints = 16 * 16, kMaxRingedPoints = 37 * 37;

// Adds the points of the placed frame's bodies. Loop; no allocation while the vector has room.
void add_body_points(const FrameContext& frame, const PointField& field, std::vector<PointSource>& points);

}  // namespace hilcam
