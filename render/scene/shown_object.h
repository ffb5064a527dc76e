#pragma once
// The scene's objects as the renderer keeps them: surfaces for shading at every level of detail.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "render/scene/scene.h"
#include "render/scene/surface.h"

namespace hilcam {

struct ShownObject {
    std::string name;
    std::vector<std::shared_ptr<const ObjectSurfaces>> levels;  // the mesh itself first; shared by its like
    std::vector<double> error_m;                                // error of each level
    std::shared_ptr<const TransferTable> transfer;  // null: no light is cached on it; shared by its like
    double turn_rate_rad_s = 0;
    // Least and greatest corners of boxes that hold the mesh, 512 at most; body axes.
    std::vector<std::array<Vec3f, 2>> bounds_m;

    // Returns how far a place [m, body axes] is from the nearest of these boxes; 0 within one.
    double distance_m(Vec3d from_m) const;
    const std::vector<Material>& materials() const { return levels.front()->materials; }
    double radius_m() const { return levels.front()->radius_m; }
};

// Per object its meshes, from fine to coarse, their triangles ordered for the cache. They stay in the scene.
// Objects that are like another have the same ones.
std::vector<std::vector<const Mesh*>> ordered_meshes(Scene& scene);
// Takes the objects out of the scene; ordered_meshes() comes first.
std::vector<ShownObject> shown_objects(Scene& scene);

}  // namespace hilcam
