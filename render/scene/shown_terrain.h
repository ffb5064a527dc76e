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

    // Returns the greatest number of triangles that its mesh is made of, about.
    std::size_t max_triangles() const { return terrain_->max_triangles; }
    // Frames wait for the mesh that they ask for.
    bool waits() const { return terrain_->wait; }
    // Returns the body with which it turns.
    std::optional<BodyId> body() const { return terrain_->body; }
    // Takes what the streamer has ready and asks it for what the camera needs; the first call, and every one
    // of a terrain that waits, makes it at once. Gives the pose of the object's mesh. Loop, but for those
    // calls.
    // half_field_rad: angle from the boresight beyond which the camera sees nothing.
    Pose update(const WorldSnapshot& world, double focal_length_px, double half_field_rad,
                ShownObject& object);

    // Returns the camera's height at the last update() over the ground, as the map has it where that is known
    // without the mesh, else over the mesh; none beside the ground. Loop.
    std::optional<double> height_above_ground_m() const;

  private:
    EmbreeScene& embree_;
    std::unique_ptr<SceneTerrain> terrain_;
    std::size_t index_;
    TerrainStreamer streamer_;
    bool any_ = false;
    Vec3d anchor_m_;        // anchor of the mesh that is shown
    TerrainView made_for_;  // the same mesh's view
    Vec3d seen_from_m_;     // the camera at the last update(), terrain axes

    bool is_stale(const TerrainView& view) const;
    void adopt(PreparedTerrain& prepared, ShownObject& object);
};

}  // namespace hilcam
