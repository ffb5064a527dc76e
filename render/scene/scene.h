#pragma once
// The scene is all there is to see, as it stands after loading: it does not change during a run. Poses come
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
    // An earlier object whose mesh, materials and levels it has, too: the fields below are then empty.
    std::optional<std::size_t> like{};
    Mesh mesh;                                        // body axes, metres
    std::vector<Material> materials;                  // one per surface of the mesh
    std::vector<MeshLevel> levels;                    // coarser ones, from fine to coarse; may be empty
    std::shared_ptr<const TransferTable> transfer{};  // shared by its like; null: no light is cached on it
    double turn_rate_rad_s = 0;                       // that it is known to begin with
};

struct SceneBody {
    bool visible = false;
    BodyLook look;
    MipTexture map;            // empty: uniform. Relative to its mean where the look is tied to a magnitude
    double map_reference = 0;  // or to this value, linear; 0: the mean
    // Factor on tan(latitude) of the normal that makes the map's latitude: (b/a)^2 for a planetocentric map.
    double map_latitude_factor = 1;
    BodyRelief relief{};       // empty: smooth
    bool planetshine = false;  // other bodies light it
    bool rings = false;        // Saturn's
    std::string name{};        // name of a body of the scenario's own
};

// Ground (terrain.h), at rest in the world or on a body that turns.
struct SceneTerrain {
    std::string name;
    std::unique_ptr<Terrain> ground;
    Pose pose;                      // in the world, without a body
    std::optional<BodyId> body;     // body with which it turns
    std::optional<Geodetic> place;  // its axes there: x east, y north, z up; none: the body's own axes
    Material material;
    double edge_px = 2;
    std::size_t max_triangles = 1'000'000;
    bool wait = false;  // frames wait for the terrain that fits them
};

struct Scene {
    std::vector<SceneObject> objects;
    std::unique_ptr<SceneTerrain> terrain;  // null: none
    std::vector<SceneLamp> lamps;
    std::vector<Star> stars;
    TimeTai stars_time;                        // time of the stars' places
    std::array<SceneBody, kMaxBodies> bodies;  // by BodyId
    std::unique_ptr<Atmosphere> air;           // the Earth's; null: none
    // Refers to air; null: the Earth is its look and map. Shared, so that scenes need not know its type.
    std::shared_ptr<const EarthModel> earth;
    Spectrum sun_irradiance_1au_w_m2_um;
    bool limb_darkening = true;
    // Objects' transfer tables come when frames are being made already (Renderer::give_tables).
    bool light_later = false;

    SceneBody& body(BodyId id) { return bodies[index_of(id)]; }
};

// One instant of the world: what a frame shows. objects: a pose per Scene::objects; lamps: as Scene::lamps.
struct WorldSnapshot {
    TimeTai time;
    Pose camera;
    Vec3d camera_velocity_m_s;  // in the world
    // The camera's velocity against what its rows see, in its own time: for rows that are not of one instant.
    Vec3d rows_velocity_m_s;
    Vec3d camera_rate_rad_s;  // about the camera's axes
    std::vector<Pose> objects;
    ShownLamps lamps;
    Bodies bodies;

    // Returns the velocity that shifts the sky. No camera is as fast as the limit (Parker Solar Probe: 192
    // km/s): what seems to be is a jump between two poses, and shifts nothing.
    Vec3d shifting_velocity_m_s() const {
        constexpr double kFastest_m_s = 1e6;
        return length(camera_velocity_m_s) < kFastest_m_s ? camera_velocity_m_s : Vec3d{};
    }
};

}  // namespace hilcam
