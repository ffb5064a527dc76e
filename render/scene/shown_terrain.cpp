#include "render/scene/shown_terrain.h"

#include <cmath>
#include <limits>
#include <utility>

namespace hilcam {
namespace {

// East, north and up at the place are the terrain's axes.
Pose pose_on_body(const SceneTerrain& terrain, const BodyState& body) {
    const Mat3d world_from_fixed = transposed(body.fixed_from_world);
    if (!terrain.place) return {body.world_m, to_quat(world_from_fixed)};
    const Mat3d fixed_from_terrain = body_fixed_from_local(*terrain.place);
    return {body.world_m + world_from_fixed * body_fixed_position_m(*terrain.body, *terrain.place),
            to_quat(world_from_fixed * fixed_from_terrain)};
}

// Extends the field, so that a slowly turning camera does not see the edge of the fine part.
constexpr double kFieldMargin_rad = 0.1;

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
      streamer_(embree, *terrain_->ground, terrain_->material) {}

// Terrain has to be made anew when the camera has moved by a fiftieth of its distance to the ground below it,
// or when its field extends beyond the one that the mesh was made for.
bool ShownTerrain::is_stale(const TerrainView& view) const {
    const TerrainView& old = made_for_;
    if (length(view.camera_m - old.camera_m) > 0.02 * length(view.camera_m - anchor_m_)) return true;
    if (!terrain_->ground->depends_on_boresight()) return false;
    const double turned_rad = angle_between_rad(view.boresight, old.boresight);
    // A tenth of the Sun's own disk.
    constexpr double kSunStep_rad = 0.001;
    return turned_rad > 0.5 * kFieldMargin_rad || view.pixel_rad != old.pixel_rad ||
           length(view.sun_dir - old.sun_dir) > kSunStep_rad;
}

Pose ShownTerrain::update(const WorldSnapshot& world, double focal_length_px, double half_field_rad,
                          ShownObject& object) {
    const Pose pose =
        terrain_->body ? pose_on_body(*terrain_, world.bodies[*terrain_->body]) : terrain_->pose;
    const Pose& camera = world.camera;
    const Mat3d world_from_terrain = to_matrix(pose.world_from_body);
    const Vec3d camera_m = transposed(world_from_terrain) * (camera.position_world_m - pose.position_world_m);
    seen_from_m_ = camera_m;
    const Vec3d boresight =
        transposed(world_from_terrain) * (to_matrix(camera.world_from_body) * Vec3d{0, 0, 1});
    const TerrainView view{
        camera_m,
        1 / focal_length_px,
        terrain_->edge_px,
        terrain_->max_triangles,
        boresight,
        half_field_rad + kFieldMargin_rad,
        transposed(world_from_terrain) * normalized(world.bodies.sun_world_m - camera.position_world_m)};
    const bool stale = !any_ || is_stale(view);
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
    anchor_m_ = prepared.anchor_m, made_for_ = prepared.view;
    any_ = true;
}

std::optional<double> ShownTerrain::height_above_ground_m() const {
    const Terrain& ground = *terrain_->ground;
    if (const auto known = ground.height_above_ground_m(seen_from_m_)) return known;
    if (!any_ || !is_finite(seen_from_m_)) return {};
    // Downwards, or upwards if nothing is below.
    const Vec3f up = to_float(ground.up_at(seen_from_m_)), from = to_float(seen_from_m_ - anchor_m_);
    RayPacket rays;
    rays.count = 2;
    rays.set(0, from, -up, 0, std::numeric_limits<float>::infinity());
    rays.set(1, from, up, 0, std::numeric_limits<float>::infinity());
    HitPacket hits;
    embree_.intersect_with(index_, rays, hits);
    for (const int side : {0, 1})
        if (const auto k = static_cast<std::size_t>(side); hits.object[k] != HitPacket::kMiss)
            return (side == 0 ? 1.0 : -1.0) * static_cast<double>(hits.distance[k]);
    return {};
}

}  // namespace hilcam
