#pragma once
// The picture of an object that is small in the frame, by a visibility buffer of its own on all threads: up
// to 128 x 128 pixels with 64 samples each, where the frame's own pixels would have a few hundred samples on
// the whole object. Glints and mirrored things are much smaller than a frame pixel, and so few samples meet
// them only by chance (docs/rendering.md, "Small objects and points").
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
    // capacity: for one object. The frame context must have its pointers and sizes already. Owner thread.
    ObjectImpostor(const FrameContext& frame, const VisibilityBuffer::Capacity& capacity);

    // Copies the state of a placed frame. Loop, like all functions below.
    void begin(const FrameContext& frame) { camera_.begin(frame); }
    // Finds the light of object `i`, cell by cell. glimpses: room for ImpostorCamera::cells_across()^2.
    // Returns false if the buffer has no room for the object.
    bool look(const FrameSetup& setup, std::size_t i, const FrameTracer& tracer, Glimpse* glimpses,
              std::size_t& count, TileStats& stats);

  private:
    // The memory of one thread.
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
