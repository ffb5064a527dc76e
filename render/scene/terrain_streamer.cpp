#include "render/scene/terrain_streamer.h"

#include <tbb/task_arena.h>

#include <chrono>

#include "render/lod/triangle_order.h"
#include "render/scene/ground_sun.h"

namespace hilcam {

TerrainStreamer::TerrainStreamer(const EmbreeScene& embree, Terrain& ground, const Material& material)
    : embree_(embree), ground_(ground), material_(material) {}

TerrainStreamer::~TerrainStreamer() {
    stop_.store(true);
    if (thread_.joinable()) thread_.join();
    delete ready_.load();
    delete used_.load();
}

std::unique_ptr<PreparedTerrain> TerrainStreamer::make(const TerrainView& view) const {
    TerrainMesh terrain = ground_.mesh(view);
    // A mesh with normals of its own has to keep its order.
    if (!terrain.normals) order_triangles(terrain.mesh);
    auto surfaces = std::make_shared<ObjectSurfaces>(terrain.mesh, std::vector{material_}, nullptr);
    if (terrain.normals) surfaces->sun_visibility = sun_visibility(terrain, view.sun_dir);
    PreparedMesh tree = terrain.grids.empty()
                            ? embree_.prepare(terrain.mesh)
                            : embree_.prepare(std::move(terrain.mesh), std::move(terrain.grids));
    surfaces->ground_normals = std::move(terrain.normals);
    return std::make_unique<PreparedTerrain>(
        PreparedTerrain{std::move(tree), std::move(surfaces), terrain.anchor_m, view});
}

void TerrainStreamer::request(const TerrainView& view) {
    wanted_.write(view);
    if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
}

void TerrainStreamer::work() {
    pthread_setname_np(pthread_self(), kTerrainThreadName);
    tbb::task_arena alone(1);  // the frames have the other threads
    TerrainView made_for, before;
    bool any = false, more_ahead = false;
    while (!stop_.load()) {
        delete used_.exchange(nullptr, std::memory_order_acquire);
        const TerrainView view = wanted_.read();
        const bool waiting = ready_.load() != nullptr;
        if (waiting || (any && view.camera_m == made_for.camera_m && view.boresight == made_for.boresight &&
                        view.sun_dir == made_for.sun_dir)) {
            more_ahead = more_ahead && alone.execute([&] { return look_ahead(before, made_for); });
            if (!more_ahead) std::this_thread::sleep_for(std::chrono::milliseconds(5));
            continue;
        }
        alone.execute([&] { ready_.store(make(view).release(), std::memory_order_release); });
        before = any ? made_for : view;
        made_for = view;
        any = more_ahead = true;
    }
}

// Predicts where the camera will be some meshes from now if it continues its motion: a camera that descends
// to half its height needs a level of new tiles, which would otherwise all be made for one mesh. Returns
// false if nothing is left to make.
bool TerrainStreamer::look_ahead(const TerrainView& before, const TerrainView& now) {
    constexpr double kMeshes[] = {2, 5, 10, 15, 20, 25};
    const Vec3d step_m = now.camera_m - before.camera_m;
    if (step_m == Vec3d{}) return false;
    for (const double meshes : kMeshes) {
        TerrainView ahead = now;
        ahead.camera_m = now.camera_m + meshes * step_m;
        if (ground_.make_ahead(ahead)) return true;
    }
    return false;
}

}  // namespace hilcam
