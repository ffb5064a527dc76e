#pragma once
// The scene's terrain as one of the renderer's objects, brought up to date with the camera.

#include <memory>
#include <optional>

#include "render/scene/scene.h"
#include "render/scene/shown_object.h"
#include "render/scene/terrain_streamer.h"

namespace hilcam {

// Gives a scene with terrain an object in its place, the last one; nothing without terrain.
Scene& with_terrain_object(Scene& scene);

class ShownTerrain {
  public:
    // index: of that object. Owner thread.
    ShownTerrain(EmbreeScene& embree, std::unique_ptr<SceneTerrain> terrain, std::size_t index);

    // Returns the body with which it turns.
    std::optional<BodyId> body() const { return terrain_->body; }
    // Takes what the streamer has ready and asks it for what the camera needs; the first call, and every one
    // of a terrain that waits, makes it at once. Gives the pose of the object's mesh. Loop, but for those
    // calls.
    Pose update(const WorldSnapshot& world, double focal_length_px, ShownObject& object);

    // Returns the camera's height at the last update(), over the ground as the map has it; none beside the
    // map. Loop.
    std::optional<double> height_above_ground_m() const {
        return hilcam::height_above_ground_m(*terrain_->map, terrain_->radius_m, seen_from_m_);
    }

  private:
    EmbreeScene& embree_;
    std::unique_ptr<SceneTerrain> terrain_;
    std::size_t index_;
    TerrainStreamer streamer_;
    bool any_ = false;
    Vec3d anchor_m_, camera_m_;  // anchor and camera of the mesh that is shown
    Vec3d seen_from_m_;          // the camera at the last update(), terrain axes

    void adopt(PreparedTerrain& prepared, ShownObject& object);
};

}  // namespace hilcam
