#pragma once
// The scene's terrain as one of the renderer's objects, kept up to date with the camera.

#include <memory>
#include <optional>

#include "render/scene/scene.h"
#include "render/scene/shown_object.h"
#include "render/scene/terrain_streamer.h"

namespace hilcam {

// Adds an object for the terrain as the scene's last one, if the scene has terrain.
Scene& with_terrain_object(Scene& scene);

class ShownTerrain {
  public:
    // index: number of that object. Owner thread.
    ShownTerrain(EmbreeScene& embree, std::unique_ptr<SceneTerrain> terrain, std::size_t index);

    // Returns the approximate largest number of triangles of its mesh.
    std::size_t max_triangles() const { return terrain_->max_triangles; }
    // True when frames wait for the mesh that they ask for.
    bool waits() const { return terrain_->wait; }
    // Returns the body that it rotates with.
    std::optional<BodyId> body() const { return terrain_->body; }
    // Takes a mesh that the streamer has finished and requests the one that the camera needs. The first call
    // makes its mesh at once, and so does every call of a terrain that waits; other calls are for the loop.
    // Returns the pose of the object's mesh. half_field_rad: angle from the boresight beyond which the camera
    // sees nothing.
    Pose update(const WorldSnapshot& world, double focal_length_px, double half_field_rad,
                ShownObject& object);

    // Returns the camera's height above the ground at the last update(): from the map if it knows it without
    // the mesh, otherwise from the mesh. Nothing beside the ground. Loop.
    std::optional<double> height_above_ground_m() const;

  private:
    EmbreeScene& embree_;
    std::unique_ptr<SceneTerrain> terrain_;
    std::size_t index_;
    TerrainStreamer streamer_;
    bool any_ = false;
    Vec3d anchor_m_;        // anchor of the mesh that is shown
    TerrainView made_for_;  // view that this mesh was made for
    Vec3d seen_from_m_;     // the camera at the last update(), terrain axes

    bool is_stale(const TerrainView& view) const;
    void adopt(PreparedTerrain& prepared, ShownObject& object);
};

}  // namespace hilcam
