#pragma once
// The scene's objects as the renderer holds them: surfaces for shading at every level of detail.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "render/scene/scene.h"
#include "render/scene/surface.h"

namespace hilcam {

struct ShownObject {
    std::string name;
    std::vector<std::shared_ptr<const ObjectSurfaces>> levels;  // full mesh first; shared by equal objects
    std::vector<double> error_m;                                // error of each level
    std::shared_ptr<const TransferTable> transfer;  // null: no light is cached; shared by equal objects
    double turn_rate_rad_s = 0;
    // Boxes (least and greatest corner) that together hold the mesh, 512 at most; body axes.
    std::vector<std::array<Vec3f, 2>> bounds_m;

    // Returns the distance from a place [m, body axes] to the nearest of these boxes; 0 inside one.
    double distance_m(Vec3d from_m) const;
    const std::vector<Material>& materials() const { return levels.front()->materials; }
    double radius_m() const { return levels.front()->radius_m; }
};

// Returns the meshes of each object, from fine to coarse, with triangles ordered for the cache. The scene
// keeps ownership. Objects that are like another get the same meshes.
std::vector<std::vector<const Mesh*>> ordered_meshes(Scene& scene);
// Moves the objects out of the scene; call ordered_meshes() first.
std::vector<ShownObject> shown_objects(Scene& scene);

}  // namespace hilcam
