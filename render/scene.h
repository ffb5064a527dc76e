#pragma once
// What there is to see, as it stands after loading: it does not change during a run. Poses come with each
// frame.

#include <string>
#include <vector>

#include "render/bodies.h"
#include "render/material.h"
#include "render/mesh.h"
#include "render/stars.h"

namespace hilcam {

struct SceneObject {
    std::string name;
    Mesh mesh;                        // body axes, metres
    std::vector<Material> materials;  // one per surface of the mesh
};

struct Earth {
    bool visible = true;
    Spectrum albedo;
    Texture map;  // empty: uniform
};

struct Scene {
    std::vector<SceneObject> objects;
    std::vector<Star> stars;
    Earth earth;
    Spectrum sun_irradiance_1au_w_m2_um;
};

// One instant of the world: what a frame shows. objects: a pose per Scene::objects.
struct WorldSnapshot {
    TimeTai time;
    Pose camera;
    std::vector<Pose> objects;
    Bodies bodies;
};

}  // namespace hilcam
