#pragma once
// Ground that follows the camera, as an interface. An implementation has heights and makes a mesh for one
// place of the camera, fine where it is near and coarse where it is far. render/ground has a map around one
// place (terrain_patch.h) and a whole body (globe_terrain.h).

#include <memory>
#include <optional>

#include "render/scene/ground_normals.h"
#include "render/scene/mesh_grid.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

// The view that a mesh is made for, in terrain axes.
struct TerrainView {
    Vec3d camera_m;
    double pixel_rad = 1e-3;
    double edge_px = 2;  // longest edge of a triangle in the picture
    std::size_t max_triangles = 1'000'000;
    Vec3d boresight{0, 0, 1};            // unit
    double half_field_rad = 3.14159265;  // angle from the boresight beyond which the camera sees nothing
    Vec3d sun_dir{0, 0, 1};              // towards the Sun, unit
};

struct TerrainMesh {
    Mesh mesh;                                     // relative to the anchor, one surface
    std::shared_ptr<const GroundNormals> normals;  // null: only the vertices' normals
    // The grids that the mesh consists of, those with normals first; empty if it does not consist of grids.
    std::vector<MeshGrid> grids;
    Vec3d anchor_m;  // terrain axes; near the camera, so that single precision suffices there
};

class Terrain {
  public:
    virtual ~Terrain() = default;
    // Returns the mesh for a view. Any thread, one at a time; allocates.
    virtual TerrainMesh mesh(const TerrainView& view) = 0;
    // Prepares a part of what a mesh for this view will need, about a hundredth of a core-second of work, so
    // that mesh() returns sooner. It does not change the meshes. False: nothing is left to prepare. Threads
    // as for mesh().
    virtual bool make_ahead(const TerrainView&) { return false; }
    // True when the mesh is coarser where the camera does not look, so that a camera that turns needs another
    // one.
    virtual bool depends_on_boresight() const = 0;
    // Returns the vertical at a point, unit. Loop, any thread.
    virtual Vec3d up_at(Vec3d point_m) const = 0;
    // Returns the height of a point above the ground along its vertical [m], negative below it, if it is
    // known without the mesh; nothing beside the map. Loop, any thread; no allocation.
    virtual std::optional<double> height_above_ground_m(Vec3d point_m) const = 0;
};

}  // namespace hilcam
