#pragma once
// The largest distance between any two of many points.

#include <span>

#include "render/vocabulary/vec.h"

namespace hilcam {

// Returns that distance in the points' own unit, exact up to rounding; 0 for fewer than two points. A tree of
// boxes skips pairs that cannot be farther apart than the best found: a million points take about a second,
// even on a sphere.
double point_diameter(std::span<const Vec3d> points);

}  // namespace hilcam
