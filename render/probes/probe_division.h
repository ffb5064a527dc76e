#pragma once
// Finds walls between the points of a probe (surface_probes.h). A ring on a deck separates the light inside
// from that outside, although both sides are one surface with one normal and a few centimetres apart. Such a
// probe becomes two, on either side of a plane.

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "render/vocabulary/vec.h"

namespace hilcam {

// A surface between two points.
struct Wall {
    Vec3f at_m, normal;  // where it is met, and its normal, on either side
};
// Returns what a ray from one point to another meets first. Any thread.
using Sight = std::function<std::optional<Wall>(Vec3f from_m, Vec3f to_m)>;

// A plane between two groups of points; above: along * place > offset.
struct ProbeDivision {
    Vec3f along;  // unit
    float offset_m = 0;

    bool is_above(Vec3f place_m) const { return dot(along, place_m) > offset_m; }
};

// Indices of the points on either side of a wall.
struct DividedPoints {
    ProbeDivision by;
    std::vector<std::size_t> below, above;
};
// Divides points that a wall separates. Returns none if no wall hides nearly all of one group from nearly all
// of the other, or if no plane separates the groups. Points that see neither group are left out. points_m:
// raised above their surface as far as low obstacles reach; each pair is tested. facing: mean normal of the
// surface, unit.
std::optional<DividedPoints> find_division(std::span<const Vec3f> points_m, Vec3f facing, const Sight& sight);

}  // namespace hilcam
