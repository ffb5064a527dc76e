#pragma once
// Walls that stand between the points of a place where light is cached (surface_probes.h). A ring on a deck keeps the light
// within from what is without, though both are one surface that faces one way, a few centimetres apart: such a place is two, on
// either side of a plane.

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "render/vocabulary/vec.h"

namespace hilcam {

// A surface that stands between two points.
struct Wall {
    Vec3f at_m, normal;  // where it is met, and its normal, to either side
};
// Returns what is met first on the way from a point to another. Any thread.
using Sight = std::function<std::optional<Wall>(Vec3f from_m, Vec3f to_m)>;

// A plane between two groups of points; above: along * place > offset.
struct ProbeDivision {
    Vec3f along;  // unit
    float offset_m = 0;

    bool is_above(Vec3f place_m) const { return dot(along, place_m) > offset_m; }
};

// Points on either side of a wall, by their numbers.
struct DividedPoints {
    ProbeDivision by;
    std::vector<std::size_t> below, above;
};
// Divides points that a wall stands between. None: there is no wall that hides nearly all of one group from nearly all of
// another, or it is not flat enough for a plane to leave them on their sides; points that see neither group are left out.
// points_m: so far above their surface that what is no wall does not reach them; each two are asked for. facing: mean of the
// surface's normals, unit.
std::optional<DividedPoints> find_division(std::span<const Vec3f> points_m, Vec3f facing, const Sight& sight);

}  // namespace hilcam
