#pragma once
// The smallest rectangle in a plane around some triangles, parallel to one of some edges.

#include <algorithm>
#include <array>
#include <limits>
#include <span>

#include "render/vocabulary/vec.h"

namespace hilcam {

// Sides (unit, across x down = the plane's normal), and their begin and end, measured from the projection of
// the origin.
struct PlaneRectangle {
    static constexpr double kFar = std::numeric_limits<double>::infinity();
    Vec3d across, down;
    double x0 = kFar, y0 = kFar, x1 = -kFar, y1 = -kFar;

    double width() const { return x1 - x0; }
    double height() const { return y1 - y0; }
    double area() const { return width() * height(); }
};

// Returns the smallest one; the first of equal ones. At least one triangle and one edge. Owner thread.
inline PlaneRectangle smallest_rectangle(std::span<const std::array<Vec3d, 3>> triangles,
                                         std::span<const Vec3d> edges, Vec3d normal) {
    PlaneRectangle best;
    double least = PlaneRectangle::kFar;
    for (const Vec3d edge : edges) {
        PlaneRectangle r;
        r.across = normalized(edge - dot(edge, normal) * normal), r.down = cross(normal, r.across);
        for (const std::array<Vec3d, 3>& triangle : triangles)
            for (const Vec3d corner : triangle) {
                const double x = dot(corner, r.across), y = dot(corner, r.down);
                r.x0 = std::min(r.x0, x), r.x1 = std::max(r.x1, x);
                r.y0 = std::min(r.y0, y), r.y1 = std::max(r.y1, y);
            }
        if (r.area() < least) least = r.area(), best = r;
    }
    return best;
}

}  // namespace hilcam
