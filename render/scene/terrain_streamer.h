#pragma once
// Terrain that follows the camera. A thread makes the next mesh while the present one is shown and hands it
// over without a lock; the replaced mesh goes back to that thread, which frees it.

#include <atomic>
#include <memory>
#include <thread>

#include "render/scene/embree_scene.h"
#include "render/scene/surface.h"
#include "render/scene/terrain.h"
#include "render/vocabulary/latest.h"

namespace hilcam {

inline constexpr const char* kTerrainThreadName = "terrain";

// A mesh that is ready for rays: tree, surfaces, and its anchor.
struct PreparedTerrain {
    PreparedMesh tree;
    std::shared_ptr<const ObjectSurfaces> surfaces;
    Vec3d anchor_m;
    TerrainView view;  // the view that it was made for
};

class TerrainStreamer {
  public:
    // References must stay valid while this exists; the material is copied. Owner thread.
    TerrainStreamer(const EmbreeScene& embree, Terrain& ground, const Material& material);
    ~TerrainStreamer();

    // Makes the terrain for a view at once. Not for the loop.
    std::unique_ptr<PreparedTerrain> make(const TerrainView& view) const;
    // Tells the thread what the camera sees; the first call starts it. Loop.
    void request(const TerrainView& view);
    // Returns the newest mesh that is ready, or null. The caller gives back the one that it replaces. Loop.
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
