#pragma once
// Terrain from one height map, which may be larger than memory: a mesh for one place of the camera. Terrain
// axes: x east, y north, z up, origin at the map's middle at height 0. On a sphere the map is laid out by
// distance and direction from its middle (azimuthal equidistant).
//
// Tiles of 32 x 32 quadrilaterals form a quadtree. The tile with the widest edges on the screen is divided
// first, until edges are as narrow as needed or the triangles are used up. The border of a tile beside a
// coarser one is on that one's edges, and small skirts close gaps from rounding. Normals are those of the
// heights at the tile's own spacing. Not modelled: overhangs, and anything beyond the map's edge.

#include <memory>
#include <optional>

#include "render/ground/height_map.h"
#include "render/scene/terrain.h"

namespace hilcam {

// radius_m: of the sphere under the map; 0: a plane. Any thread; allocates.
TerrainMesh terrain_mesh(const HeightMap& map, double radius_m, const TerrainView& view);

// Returns the height of a point (terrain axes) above the ground along its vertical [m], negative below it;
// bilinear between the four posts around it. None outside the map. Loop, any thread; no allocation.
std::optional<double> height_above_ground_m(const HeightMap& map, double radius_m, Vec3d point_m);

class TerrainPatch final : public Terrain {
  public:
    TerrainPatch(std::unique_ptr<const HeightMap> map, double radius_m)
        : map_(std::move(map)), radius_m_(radius_m) {}

    TerrainMesh mesh(const TerrainView& view) override { return terrain_mesh(*map_, radius_m_, view); }
    bool depends_on_boresight() const override { return false; }
    Vec3d up_at(Vec3d point_m) const override {
        return radius_m_ > 0 ? normalized(point_m + Vec3d{0, 0, radius_m_}) : Vec3d{0, 0, 1};
    }
    std::optional<double> height_above_ground_m(Vec3d point_m) const override {
        return hilcam::height_above_ground_m(*map_, radius_m_, point_m);
    }

  private:
    std::unique_ptr<const HeightMap> map_;
    double radius_m_;
};

}  // namespace hilcam
