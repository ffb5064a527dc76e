#pragma once
// Flat parts of a mesh that mirror, as light that they throw sees them: a plane, a rectangle in it, and a map
// of what the mirror fills there. Tiles of a radiator or cells of a panel that lie in one plane are one
// mirror.
//
// Coplanar means: leaning less than 0.3 degrees, the Sun's half disk and a bit, off the largest of them, and
// as near to its plane as the object is accurate (a ten-thousandth of its size, a millimetre at least).
// Curved surfaces are none: those whose corner normals lean away from their triangles, and what is too small
// by itself. Both sides of a triangle mirror.

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
    Vec3f normal;               // body axes, unit; either way
    Vec3f corner_m;             // corner of the rectangle, body axes
    Vec3f across, down;         // its sides, body axes, unit; normal = across x down
    float width_m = 0, height_m = 0;
    float tolerance_m = 0;  // greatest distance of the surface from its plane
    float area_m2 = 0;

    // The share of a rectangle that the mirror fills. middle_m: along the sides from the corner; size_m:
    // along them, at least a cell's, else as one of that size. Continuous in all four. Loop, any thread.
    float filled(Vec2f middle_m, Vec2f size_m) const;
    // Returns the middle of the part of a rectangle that lies in the mirror's own. Both as filled() has them.
    Vec2f middle_within(Vec2f middle_m, Vec2f size_m) const;
    // Returns the place that the mirror fills which is nearest to another in its plane: the middle of a cell. Along the sides from
    // the corner. Loop, any thread.
    Vec2f nearest_filled(Vec2f place_m) const;
    // The map is this fine.
    Vec2f cell_m() const { return {width_m / kCells, height_m / kCells}; }
    // True when a place of the body lies in it, about; normal: there, either way.
    bool holds(Vec3f point_m, Vec3f normal_there) const;

    // Adds a triangle to the map; the corners are of the mirror's surface. Owner thread.
    void draw(const Vec3f& a, const Vec3f& b, const Vec3f& c);
    // Ends that.
    void sum_up();

  private:
    static constexpr int kCells = 256;  // along each side
    // Before sum_up(), this is 1 where a cell's middle is filled; afterwards it holds sums over all cells to
    // the left and above (summed-area table: Crow, SIGGRAPH 84), from which the mean of any rectangle is four
    // values.
    std::vector<std::uint32_t> sums_ = std::vector<std::uint32_t>((kCells + 1) * (kCells + 1));

    std::vector<std::uint16_t> nearest_;  // by cell: the filled cell that is nearest

    void find_nearest();
    double sum_to(double x, double y) const;
};

// The flat mirrors of a mesh, those that throw the most light first, kMaxFlatMirrors of them at most.
// throws: by surface, the share of the light that it mirrors; 0: it is no mirror. Owner thread.
inline constexpr std::size_t kMaxFlatMirrors = 8;
std::vector<FlatMirror> find_flat_mirrors(const MeshView& mesh, const ObjectSurfaces& surfaces,
                                          std::span<const float> throws);

}  // namespace hilcam
