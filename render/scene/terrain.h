#pragma once
// Terrain from a height map: a mesh for one place of the camera, fine where it is near and coarse where it is
// far, so that a map larger than memory can be looked at. Terrain axes: x east, y north, z up, origin at the
// map's middle at height 0. On a sphere the map is laid out by distance and direction from that middle
// (azimuthal equidistant).
//
// Tiles of 32 x 32 quadrilaterals in a quadtree; the tile whose edges are widest on the screen is split
// first, until edges are as narrow as asked for or the triangles are used up. Where a tile meets a coarser
// one its border lies on that one's edges; small skirts keep rounding from opening gaps. Normals are those of
// the heights at the tile's own spacing. Not modelled: overhangs, and what lies beyond the map's edge.

#include <optional>

#include "render/scene/height_map.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

struct TerrainView {
    Vec3d camera_m;  // terrain axes
    double pixel_rad = 1e-3;
    double edge_px = 2;  // greatest edge of a triangle on the screen
    std::size_t most_triangles = 1'000'000;
};

struct TerrainMesh {
    Mesh mesh;       // about the anchor, one surface
    Vec3d anchor_m;  // terrain axes; near the camera, so that single precision keeps its digits there
};

// radius_m: of the sphere under the map; 0: a plane. Any thread; allocates.
TerrainMesh terrain_mesh(const HeightMap& map, double radius_m, const TerrainView& view);

// Returns the height of a point, in terrain axes, above the ground along its own vertical [m], bilinear
// between the map's four posts around; negative: below it. None beside the map. Loop, any thread; no
// allocation.
std::optional<double> height_above_ground_m(const HeightMap& map, double radius_m, Vec3d point_m);

}  // namespace hilcam
