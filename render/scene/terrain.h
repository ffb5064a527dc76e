#pragma once
// Ground that follows the camera, as an interface: whoever has heights makes a mesh for one place of the camera, fine
// where it is near and coarse where it is far. render/ground has a map about one place (terrain_patch.h) and a whole body (globe_terrain.h).

#include <memory>
#include <optional>

#include "render/scene/ground_normals.h"
#include "render/scene/mesh_grid.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

// A view is what a mesh is made for. Terrain axes.
struct TerrainView {
    Vec3d camera_m;
    double pixel_rad = 1e-3;
    double edge_px = 2;  // greatest edge of a triangle on the screen
    std::size_t max_triangles = 1'000'000;
    Vec3d boresight{0, 0, 1};            // unit
    double half_field_rad = 3.14159265;  // angle from the boresight beyond which the camera sees nothing
    Vec3d sun_dir{0, 0, 1};              // towards the Sun, unit
};

struct TerrainMesh {
    Mesh mesh;                                     // about the anchor, one surface
    std::shared_ptr<const GroundNormals> normals;  // null: the vertices' own are all
    // All that the mesh is made of, those with normals first; empty where there are none.
    std::vector<MeshGrid> grids;
    Vec3d anchor_m;  // terrain axes; near the camera, so that single precision keeps its digits there
};

class Terrain {
  public:
    virtual ~Terrain() = default;
    // Returns the mesh for a view. Any thread, one at a time; allocates.
    virtual TerrainMesh mesh(const TerrainView& view) = 0;
    // Makes some of what a mesh for a view will need, a hundredth of a core-second's worth, about, so that it comes sooner when it
    // is asked for. Meshes are the same without. False: there is nothing left to make. Threads as mesh().
    virtual bool make_ahead(const TerrainView&) { return false; }
    // True where what the camera does not see is coarser, so that a camera that turns needs another mesh.
    virtual bool depends_on_boresight() const = 0;
    // Returns the vertical at a point, unit. Loop, any thread.
    virtual Vec3d up_at(Vec3d point_m) const = 0;
    // Returns the height of a point above the ground along its own vertical [m], negative: below it, where that is
    // known without the mesh; none beside the map. Loop, any thread; no allocation.
    virtual std::optional<double> height_above_ground_m(Vec3d point_m) const = 0;
};

}  // namespace hilcam
