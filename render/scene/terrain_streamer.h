#pragma once
// Terrain that follows the camera: a thread makes the next mesh while the present one is shown, and hands it
// over without a lock; what is replaced goes back to that thread to be freed.

#include <atomic>
#include <memory>
#include <thread>

#include "render/scene/embree_scene.h"
#include "render/scene/surface.h"
#include "render/scene/terrain.h"
#include "render/vocabulary/latest.h"

namespace hilcam {

inline constexpr const char* kTerrainThreadName = "terrain";

// Ready for rays: tree, surfaces, and where its anchor is.
struct PreparedTerrain {
    PreparedMesh tree;
    std::shared_ptr<const ObjectSurfaces> surfaces;
    Vec3d anchor_m;
    TerrainView view;  // view that it was made for
};

class TerrainStreamer {
  public:
    // All but the material must outlive this. Owner thread.
    TerrainStreamer(const EmbreeScene& embree, Terrain& ground, const Material& material);
    ~TerrainStreamer();

    // Makes terrain for a view at once. Not for the loop.
    std::unique_ptr<PreparedTerrain> make(const TerrainView& view) const;
    // Tells the thread what the camera sees now; starts it at the first call. Loop.
    void request(const TerrainView& view);
    // The newest that is ready, or null. Whoever takes it gives back what it replaces. Loop.
    PreparedTerrain* take() { return ready_.exchange(nullptr, std::memory_order_acquire); }
    void give_back(PreparedTerrain* used) { used_.store(used, std::memory_order_release); }

  private:
    const EmbreeScene& embree_;
    Terrain& ground_;
    Material material_;
    Latest<TerrainView> wanted_;
    std::atomic<PreparedTerrain*> ready_{nullptr}, used_{nullptr};
    std::atomic<bool> stop_{false};
    std::thread thread_;

    void work();
    bool look_ahead(const TerrainView& before, const TerrainView& now);
};

}  // namespace hilcam
