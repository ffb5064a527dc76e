#include "render/scene/terrain_streamer.h"

#include <chrono>

#include "render/scene/triangle_order.h"

namespace hilcam {

TerrainStreamer::TerrainStreamer(const EmbreeScene& embree, const HeightMap& map, double radius_m,
                                 const Material& material)
    : embree_(embree), map_(map), radius_m_(radius_m), material_(material) {}

TerrainStreamer::~TerrainStreamer() {
    stop_.store(true);
    if (thread_.joinable()) thread_.join();
    delete ready_.load();
    delete used_.load();
}

std::unique_ptr<PreparedTerrain> TerrainStreamer::make(const TerrainView& view) const {
    TerrainMesh terrain = terrain_mesh(map_, radius_m_, view);
    order_triangles(terrain.mesh);
    return std::make_unique<PreparedTerrain>(
        PreparedTerrain{embree_.prepare(terrain.mesh),
                        std::make_shared<const ObjectSurfaces>(terrain.mesh, std::vector{material_}, nullptr),
                        terrain.anchor_m, view.camera_m});
}

void TerrainStreamer::request(const TerrainView& view) {
    wanted_.write(view);
    if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
}

void TerrainStreamer::work() {
    Vec3d made_for;
    bool any = false;
    while (!stop_.load()) {
        delete used_.exchange(nullptr, std::memory_order_acquire);
        const TerrainView view = wanted_.read();
        const bool waiting = ready_.load() != nullptr;
        if (waiting || (any && view.camera_m == made_for)) {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            continue;
        }
        ready_.store(make(view).release(), std::memory_order_release);
        made_for = view.camera_m;
        any = true;
    }
}

}  // namespace hilcam
