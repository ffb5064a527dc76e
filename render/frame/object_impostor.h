#pragma once
// The picture of an object that is small in the frame, by a visibility buffer of its own on all threads: 64 samples in each of up
// to 128 x 128 pixels, where the frame's own pixels would have a few hundred on all of it. Glints and what mirrors show are much smaller
// than a pixel there, and few samples meet them by chance or not at all
// (docs/decisions.md#small-and-many-objects).
//
// Not modelled: what is seen through the object's glass.

#include <memory>
#include <vector>

#include "render/frame/impostor_camera.h"
#include "render/shading/path_model.h"
#include "render/sunlight/penumbra_sampler.h"
#include "render/visibility/visibility_buffer.h"

namespace hilcam {

class FrameSetup;
class FrameTracer;

class ObjectImpostor {
  public:
    // room: for one object. The frame's view must have its pointers and sizes by now. Owner thread.
    ObjectImpostor(const FrameContext& frame, const VisibilityBuffer::Capacity& capacity);

    // Takes over what a frame has placed. Loop, as all that follows.
    void begin(const FrameContext& frame) { camera_.begin(frame); }
    // Finds the light of object `i` cell by cell. glimpses: room for ImpostorCamera::cells_across()^2. False: the buffer has no
    // room for it.
    bool look(const FrameSetup& setup, std::size_t i, const FrameTracer& tracer, Glimpse* glimpses,
              std::size_t& count, TileStats& stats);

  private:
    // A thread has one.
    struct Slot {
        std::vector<Spectrum> tile = std::vector<Spectrum>(PathModel::kMaxSamples);
        VisibilityTile seen;
        PenumbraSampler penumbra;
        NormalClusters clusters;
        TileStats stats;
    };
    ImpostorCamera camera_;
    VisibilityBuffer buffer_;
    std::vector<std::unique_ptr<Slot>> slots_;
    std::vector<Spectrum> picture_;

    void trace_tile(const PixelBox& box, Slot& slot, PathModel& paths);
};

}  // namespace hilcam
