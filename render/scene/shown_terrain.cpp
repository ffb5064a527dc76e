#include "render/scene/shown_terrain.h"

#include <utility>

namespace hilcam {
namespace {

// East, north and up at the place are the terrain's axes.
Pose pose_on_body(const SceneTerrain& terrain, const BodyState& body) {
    const Mat3d fixed_from_terrain = body_fixed_from_local(terrain.place);
    const Mat3d world_from_fixed = transposed(body.fixed_from_world);
    return {body.world_m + world_from_fixed * body_fixed_position_m(*terrain.body, terrain.place),
            to_quat(world_from_fixed * fixed_from_terrain)};
}

}  // namespace

Scene& with_terrain_object(Scene& scene) {
    if (!scene.terrain) return scene;
    // A triangle until the camera is known.
    SceneObject object;
    object.name = scene.terrain->name;
    object.mesh.vertices_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    object.mesh.triangles = {{0, 1, 2}};
    object.mesh.surface_of_triangle = {0};
    object.mesh.surfaces.resize(1);
    object.materials = {scene.terrain->material};
    scene.objects.push_back(std::move(object));
    return scene;
}

ShownTerrain::ShownTerrain(EmbreeScene& embree, std::unique_ptr<SceneTerrain> terrain, std::size_t index)
    : embree_(embree),
      terrain_(std::move(terrain)),
      index_(index),
      streamer_(embree, *terrain_->map, terrain_->radius_m, terrain_->material) {}

Pose ShownTerrain::update(const WorldSnapshot& world, double focal_length_px, ShownObject& object) {
    const Pose pose =
        terrain_->body ? pose_on_body(*terrain_, world.bodies[*terrain_->body]) : terrain_->pose;
    const Pose& camera = world.camera;
    const Mat3d world_from_terrain = to_matrix(pose.world_from_body);
    const Vec3d camera_m = transposed(world_from_terrain) * (camera.position_world_m - pose.position_world_m);
    seen_from_m_ = camera_m;
    const TerrainView view{camera_m, 1 / focal_length_px, terrain_->edge_px, terrain_->most_triangles};
    // Other terrain is needed once the camera has moved by a fiftieth of its distance to the ground under it.
    const bool stale = !any_ || length(camera_m - camera_m_) > 0.02 * length(camera_m - anchor_m_);
    if (!any_ || (stale && terrain_->wait)) {
        const std::unique_ptr<PreparedTerrain> made = streamer_.make(view);
        adopt(*made, object);
        if (!terrain_->wait) streamer_.request(view);
    } else if (!terrain_->wait) {
        if (stale) streamer_.request(view);
        if (PreparedTerrain* const ready = streamer_.take()) {
            adopt(*ready, object);
            streamer_.give_back(ready);
        }
    }
    return {pose.position_world_m + world_from_terrain * anchor_m_, pose.world_from_body};
}

void ShownTerrain::adopt(PreparedTerrain& prepared, ShownObject& object) {
    embree_.adopt(index_, prepared.tree);
    std::swap(object.levels.front(), prepared.surfaces);
    anchor_m_ = prepared.anchor_m, camera_m_ = prepared.camera_m;
    any_ = true;
}

}  // namespace hilcam
