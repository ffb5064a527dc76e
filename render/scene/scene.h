#pragma once
// The scene: everything that can be seen, as it is after loading. It does not change during a run; poses come
// with each frame.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/lod/mesh_lod.h"
#include "render/scene/color_bands.h"
#include "render/scene/lamp.h"
#include "render/scene/material.h"
#include "render/scene/terrain.h"
#include "render/sky/atmosphere.h"
#include "render/sky/bodies.h"
#include "render/sky/body_photometry.h"
#include "render/sky/body_relief.h"
#include "render/sky/stars.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

class EarthModel;
class TransferTable;

struct SceneObject {
    std::string name;
    // An earlier object whose mesh, materials and levels this one shares; the fields below are then empty.
    std::optional<std::size_t> like{};
    Mesh mesh;                        // body axes, metres
    std::vector<Material> materials;  // one per surface of the mesh
    std::vector<MeshLevel> levels;    // coarser meshes, from fine to coarse; may be empty
    // Shared with objects of the same mesh; null: no light is cached.
    std::shared_ptr<const TransferTable> transfer{};
    double turn_rate_rad_s = 0;  // known rate at the start
};

struct SceneBody {
    bool visible = false;
    BodyLook look;
    MipTexture map;            // empty: uniform. Relative to its mean if the look is tied to a magnitude
    double map_reference = 0;  // value that the map is relative to, linear; 0: the mean
    // Factor on tan(latitude) of the normal that gives the map's latitude: (b/a)^2 for a planetocentric map.
    double map_latitude_factor = 1;
    BodyRelief relief{};       // empty: smooth
    bool planetshine = false;  // other bodies light this one
    bool rings = false;        // Saturn's rings
    std::string name{};        // name of a body that the scenario defines
};

// Ground (terrain.h), at rest in the world or on a rotating body.
struct SceneTerrain {
    std::string name;
    std::unique_ptr<Terrain> ground;
    Pose pose;                      // in the world; not used on a body
    std::optional<BodyId> body;     // body that it rotates with
    std::optional<Geodetic> place;  // origin of its axes: x east, y north, z up; none: the body's own axes
    Material material;
    double edge_px = 2;
    std::size_t max_triangles = 1'000'000;
    bool wait = false;  // frames wait for the mesh that fits them
};

struct Scene {
    std::vector<SceneObject> objects;
    std::unique_ptr<SceneTerrain> terrain;  // null: none
    std::vector<SceneLamp> lamps;
    std::vector<Star> stars;
    TimeTai stars_time;                        // epoch of the stars' positions
    std::array<SceneBody, kMaxBodies> bodies;  // by BodyId
    std::unique_ptr<Atmosphere> air;           // the Earth's; null: none
    // Refers to `air`; null: the Earth is drawn by its look and map. Shared, so that scenes need not know its
    // type.
    std::shared_ptr<const EarthModel> earth;
    Spectrum sun_irradiance_1au_w_m2_um;
    bool limb_darkening = true;
    // Transfer tables are delivered while frames are already being made (Renderer::give_tables).
    bool light_later = false;

    SceneBody& body(BodyId id) { return bodies[index_of(id)]; }
};

// One instant of the world, as a frame shows it. objects: a pose for each of Scene::objects; lamps: as
// Scene::lamps.
struct WorldSnapshot {
    TimeTai time;
    Pose camera;
    Vec3d camera_velocity_m_s;  // in the world
    // The camera's velocity relative to what its rows see, in its own time; for cameras whose rows are
    // exposed one after the other.
    Vec3d rows_velocity_m_s;
    Vec3d camera_rate_rad_s;  // about the camera's axes
    std::vector<Pose> objects;
    ShownLamps lamps;
    Bodies bodies;

    // Returns the velocity for aberration. Above the limit it returns zero: no camera is that fast (Parker
    // Solar Probe: 192 km/s), so the velocity comes from a jump between two poses.
    Vec3d shifting_velocity_m_s() const {
        constexpr double kFastest_m_s = 1e6;
        return length(camera_velocity_m_s) < kFastest_m_s ? camera_velocity_m_s : Vec3d{};
    }
};

}  // namespace hilcam
