#pragma once
// The flat parts of a mesh that mirror sunlight: each has a plane, a rectangle in it, and a map of where the
// mirror fills the rectangle. Tiles of a radiator or cells of a panel in one plane are one mirror.
//
// Coplanar triangles lean less than 0.3 degrees from the largest one (slightly more than half the Sun's disk)
// and are as near to its plane as the object is accurate: a ten-thousandth of its size, at least a
// millimetre. Curved surfaces are excluded: those whose corner normals differ from their triangles', and
// single pieces that are too small. Both sides of a triangle mirror.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "render/scene/embree_scene.h"
#include "render/scene/surface.h"

namespace hilcam {

class FlatMirror {
  public:
    std::uint16_t surface = 0;  // surface of the mesh
    Vec3f normal;               // body axes, unit; either side
    Vec3f corner_m;             // corner of the rectangle, body axes
    Vec3f across, down;         // sides of the rectangle, body axes, unit; normal = across x down
    float width_m = 0, height_m = 0;
    float tolerance_m = 0;  // largest distance of the surface from its plane
    float area_m2 = 0;

    // Returns the share of a rectangle that the mirror fills. middle_m: from the corner, along the sides.
    // size_m: at least the size of a cell, smaller values count as that. Continuous in all four numbers.
    // Loop, any thread.
    float filled(Vec2f middle_m, Vec2f size_m) const;
    // Returns the middle of the part of a rectangle that is inside the mirror's own; arguments as for
    // filled().
    Vec2f middle_within(Vec2f middle_m, Vec2f size_m) const;
    // Returns the filled place nearest to a place in the plane: the middle of a cell, along the sides from
    // the corner. Loop, any thread.
    Vec2f nearest_filled(Vec2f place_m) const;
    // The resolution of the map.
    Vec2f cell_m() const { return {width_m / kCells, height_m / kCells}; }
    // True when a point of the body is in the mirror, approximately. normal: at the point, either side.
    bool holds(Vec3f point_m, Vec3f normal_there) const;

    // Adds a triangle of the mirror's surface to the map. Owner thread.
    void draw(const Vec3f& a, const Vec3f& b, const Vec3f& c);
    // Completes the map.
    void sum_up();

  private:
    static constexpr int kCells = 256;  // along each side
    // A 1 marks a cell whose middle is filled, until sum_up() replaces the marks by sums over all cells to
    // the left and above (summed-area table: Crow, SIGGRAPH 84), which give the mean of any rectangle from
    // four values.
    std::vector<std::uint32_t> sums_ = std::vector<std::uint32_t>((kCells + 1) * (kCells + 1));

    std::vector<std::uint16_t> nearest_;  // by cell: the nearest filled cell

    void find_nearest();
    double sum_to(double x, double y) const;
};

// Returns the flat mirrors of a mesh, in falling order of the light that they reflect, kMaxFlatMirrors at
// most. throws: by surface, the share of light that it mirrors; 0: it is not a mirror. Owner thread.
inline constexpr std::size_t kMaxFlatMirrors = 8;
std::vector<FlatMirror> find_flat_mirrors(const MeshView& mesh, const ObjectSurfaces& surfaces,
                                          std::span<const float> throws);

}  // namespace hilcam
