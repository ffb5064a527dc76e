#pragma once
// The largest distance between any two of many points.

#include <span>

#include "render/vocabulary/vec.h"

namespace hilcam {

// Returns that distance in the points' own unit, exact but for rounding; 0 for fewer than two points. Boxes of a
// tree over the points leave out pairs that cannot be farther apart than what was found, so that a million
// points take about a second, even on a sphere.
double point_diameter(std::span<const Vec3d> points);

}  // namespace hilcam
