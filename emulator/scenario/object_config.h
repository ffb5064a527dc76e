#pragma once
// The things in the world: objects with their poses, meshes and joints, and terrain.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "emulator/ground/globe_config.h"
#include "emulator/scenario/motion_config.h"
#include "emulator/world/world_state.h"
#include "io/files/height_map_file.h"
#include "render/scene/material.h"
#include "render/sky/bodies.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

// The initial pose of a thing, until commands change it.
struct PoseConfig {
    enum class Frame { kWorld, kLocal } frame = Frame::kWorld;
    enum class Attitude { kQuaternion, kLookAt, kNadir } attitude = Attitude::kQuaternion;
    Vec3d position_m;
    AttitudeForms forms;
    BodyId nadir_of = BodyId::kEarth;
    Vec3d look_at_m;
    Vec3d up{0, 0, 1};
    Vec3d velocity_m_s;
    Vec3d rate_body_rad_s;
    bool has_attitude = false, has_look_at = false, has_up = false, has_nadir_of = false;
    bool has_velocity = false, has_rate = false;
};
Fields fields(PoseConfig& pose);
void validate(const PoseConfig& pose);
// Returns the named attitude, or the one that other keys imply: `look_at_m` or `up` imply look_at.
PoseConfig::Attitude attitude_of(const PoseConfig& pose);
// Returns the motion for a pose in the world's frame at an instant (for the local frame, see site.h). Throws
// InputError when look_at is not defined.
Motion initial_motion(const PoseConfig& pose, TimeTai time, const Bodies& bodies);

struct GeneratedMeshConfig {
    std::string program;
    std::int64_t triangles = 100000;
    std::int64_t seed = 1;
    double wing_angle_deg = 0;
};
Fields fields(GeneratedMeshConfig& mesh);

struct MaterialSet {
    std::vector<SurfaceConfig> surfaces;
};
Fields fields(MaterialSet& set);

// A part of an object that rotates about an axis: a solar wing, a gimbal.
struct JointConfig {
    std::string node;
    Vec3d pivot_m;
    Vec3d axis{0, 0, 1};
    double angle_rad = 0;
    double rate_rad_s = 0;
};
Fields fields(JointConfig& joint);
void validate(const JointConfig& joint);

struct ObjectConfig {
    std::string name;
    std::filesystem::path mesh;
    std::string mesh_where;  // place of the key in the scenario
    std::int64_t mesh_surface = 0;
    std::filesystem::path albedo_file;
    std::string albedo_where;  // place of the key in the scenario
    double albedo_reference = 0;
    double temperature_k = 0;  // holds for surfaces that have none
    std::optional<GeneratedMeshConfig> generate;
    double scale = 1;
    PoseConfig pose;
    std::optional<MotionConfig> motion;
    MaterialSet materials;
    std::vector<JointConfig> joints;
    bool has_mesh = false, has_mesh_surface = false;
    bool has_albedo_file = false, has_albedo_reference = false;
    bool has_pose = false;
};
Fields fields(ObjectConfig& object);
void validate(const ObjectConfig& object);

// A place on a body.
struct PlaceConfig {
    BodyId body = BodyId::kMoon;
    Geodetic place;
};
Fields fields(PlaceConfig& place);

// Ground from a height map, at rest in the world or on a turning body; or the ground of a whole body.
struct TerrainConfig {
    std::string name = "terrain";
    std::optional<HeightMapConfig> heights;
    std::optional<GlobeConfig> globe;
    double radius_m = 0;
    PoseConfig pose;
    std::optional<PlaceConfig> place;
    bool has_pose = false, has_radius = false;
    MaterialConfig material;
    double edge_px = 2;
    std::int64_t max_triangles = 1'000'000;
    bool wait = false;
};
Fields fields(TerrainConfig& terrain);
void validate(const TerrainConfig& terrain);

}  // namespace hilcam
