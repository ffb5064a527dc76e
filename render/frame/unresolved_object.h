#pragma once
// The small picture of an object that is a few pixels wide or less, by a grid of rays of its own. It serves
// ray visibility, terrain, and scenes with more objects than can have an ObjectImpostor (object_impostor.h),
// which has more samples.

#include <memory>
#include <vector>

#include "render/frame/impostor_camera.h"
#include "render/shading/path_model.h"

namespace hilcam {

class UnresolvedObject {
  public:
    // max_samples: rays along one axis of the largest picture. The frame context must have its pointers and
    // sizes already. Owner thread.
    UnresolvedObject(const FrameContext& frame, int max_samples);

    // Copies the state of a placed frame. Loop, like all functions below.
    void begin(const FrameContext& frame) { camera_.begin(frame); }
    // Finds the light of object `i` with a bounding sphere of radius_m, cell by cell. glimpses: room for
    // ImpostorCamera::cells_across()^2. Returns the number of cells with light; adds the tracing costs to
    // stats.
    std::size_t look(const WorldSnapshot& world, std::size_t i, const ObjectPlan& plan, double radius_m,
                     PathModel& paths, Glimpse* glimpses, TileStats& stats);

  private:
    ImpostorCamera camera_;
    std::vector<Spectrum> tile_, picture_;
    std::unique_ptr<NormalClusters> clusters_ = std::make_unique<NormalClusters>();

    TileStats trace(int samples, PathModel& paths);
};

}  // namespace hilcam
