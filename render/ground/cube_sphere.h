#pragma once
// Maps directions from a body's centre, or normals of its ellipsoid, to the six faces of a cube. Each face is
// a square with two coordinates, angles from its middle: -1 to 1 for -45 to 45 deg (the equiangular
// projection; Ronchi, Iacono and Paolucci, J. Comput. Phys. 124, 93, 1996). The edges of its squares differ
// by a factor below 1.42. Along a common edge two faces have the same coordinate, possibly in the opposite
// direction, so their points there are identical.

#include <array>
#include <cmath>

#include "render/vocabulary/units.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

inline constexpr int kCubeFaces = 6;

struct CubeFace {
    Vec3d axis, right, up;  // right x up = axis
};
inline constexpr std::array<CubeFace, kCubeFaces> kCube = {{
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},
    {{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}},
    {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
    {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}},
    {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}},
}};

struct CubePoint {
    int face = 0;
    Vec2d at;  // right, up; within -1 .. 1
};

// Two directions along the ground at a place, at right angles to it and to each other: east and north, except
// near poles.
struct AlongGround {
    Vec3d east, north;
};
inline AlongGround axes_along(Vec3d place) {
    const Vec3d aside = std::abs(place.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
    const Vec3d east = normalized(cross(aside, place));
    return {east, cross(place, east)};
}

// Returns the tangent of a coordinate's angle; exact at 45 deg, so that faces meet.
inline double cube_tangent(double at) { return std::abs(at) == 1 ? at : std::tan(0.25 * kPi * at); }
// Returns the unit vector of a point from the tangents of its two coordinates.
inline Vec3d cube_direction_of_tangents(int face, Vec2d tangents) {
    const CubeFace& f = kCube[static_cast<std::size_t>(face)];
    return normalized(f.axis + tangents.x * f.right + tangents.y * f.up);
}
// Returns the unit vector of a point; coordinates may be slightly outside the face.
inline Vec3d cube_direction(int face, Vec2d at) {
    return cube_direction_of_tangents(face, {cube_tangent(at.x), cube_tangent(at.y)});
}

// Returns the point of a direction, which may have any length.
inline CubePoint cube_point(Vec3d dir) {
    CubePoint out;
    double most = -1;
    for (int face = 0; face < kCubeFaces; ++face)
        if (const double along = dot(kCube[static_cast<std::size_t>(face)].axis, dir); along > most)
            most = along, out.face = face;
    const CubeFace& f = kCube[static_cast<std::size_t>(out.face)];
    out.at = {std::atan(dot(f.right, dir) / most) * 4 / kPi, std::atan(dot(f.up, dir) / most) * 4 / kPi};
    return out;
}

}  // namespace hilcam
