#pragma once
// The building blocks of a spacecraft: sheets, boxes, tubes, bodies of revolution, crumpled foil.

#include <cstdint>

#include "tools/make_spacecraft/patch.h"

namespace spacecraft {

// A frame somewhere: an origin and three unit axes, right-handed, so that what faces outwards faces outwards
// there, too.
class Placement {
  public:
    Vec3d origin, x, y, z;

    explicit Placement(Vec3d at) : Placement(at, {1, 0, 0}, {0, 1, 0}) {}
    // along_x and along_y: unit, at right angles.
    Placement(Vec3d at, Vec3d along_x, Vec3d along_y)
        : origin(at), x(along_x), y(along_y), z(cross(along_x, along_y)) {}
    Vec3d operator()(Vec3d p) const { return origin + p.x * x + p.y * y + p.z * z; }
};

// A flat sheet from `corner` along `along_u` and `along_v`.
Patch sheet(std::string part, std::string material, Vec3d corner, Vec3d along_u, Vec3d along_v,
            double detail);

// Multi-layer insulation: a sheet crumpled like foil. Its height is a sum of facets on three scales
// (piecewise linear noise on triangular lattices of 18, 6 and 2 cm) that bulges between its seams and is
// pinned to them.
Patch blanket(std::string part, std::string material, Vec3d corner, Vec3d along_u, Vec3d along_v,
              double detail, std::uint32_t seed);

// Appends the six faces of a box, each one patch.
void add_box(std::vector<Patch>& patches, const std::string& part, const std::string& material,
             const Placement& place, Vec3d size, double detail);

// A body of revolution about the placement's z axis: profile(t) gives (radius, z) for t in [0, 1].
Patch revolution(std::string part, std::string material, const Placement& place,
                 std::function<std::array<double, 2>(double)> profile, int min_around, int min_along,
                 double detail);

// A round tube from a to b.
Patch tube(std::string part, std::string material, Vec3d a, Vec3d b, double radius, double detail);

// Deterministic noise in [0, 1) of a lattice point.
double lattice_value(std::uint32_t seed, std::int64_t i, std::int64_t j);

}  // namespace spacecraft
