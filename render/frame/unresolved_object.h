#pragma once
// The little picture of an object that is a few pixels wide or less, by rays of its own: a grid of them, of which each has the light
// of what it meets. It serves rays as a visibility, terrain, and scenes of more objects than have pictures (object_impostor.h),
// which see more of them.

#include <memory>
#include <vector>

#include "render/frame/impostor_camera.h"
#include "render/shading/path_model.h"

namespace hilcam {

class UnresolvedObject {
  public:
    // max_samples: rays along an axis of the largest picture. The frame's view must have its pointers and sizes by
    // now. Owner thread.
    UnresolvedObject(const FrameContext& frame, int max_samples);

    // Takes over what a frame has placed. Loop, as all that follows.
    void begin(const FrameContext& frame) { camera_.begin(frame); }
    // Finds the light of object `i`, of a sphere of radius_m, cell by cell. glimpses: room for
    // ImpostorCamera::cells_across()^2. Returns how many have any; adds to stats what it took to trace.
    std::size_t look(const WorldSnapshot& world, std::size_t i, const ObjectPlan& plan, double radius_m,
                     PathModel& paths, Glimpse* glimpses, TileStats& stats);

  private:
    ImpostorCamera camera_;
    std::vector<Spectrum> tile_, picture_;
    std::unique_ptr<NormalClusters> clusters_ = std::make_unique<NormalClusters>();

    TileStats trace(int samples, PathModel& paths);
};

}  // namespace hilcam
