#pragma once
// A path model follows light paths behind what the camera sees; one of the program's exchangeable models.
//
//   direct   what the camera sees, lit by the Sun; nothing else
//   kept     light between surfaces and from the bodies out of what is cached (indirect_cache.h), rays for mirrors;
//            random paths where nothing is cached
//   path     random paths with next-event estimation, multiple importance sampling and Russian roulette
// A path ends where it leaves the scene, where it can no longer add contribution_threshold, or at max_depth
// surfaces.

#include <memory>

#include "render/shading/tile.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/image.h"

namespace hilcam {

// Scratch memory for one thread and the code that uses it. One thread at a time; nothing is allocated after
// construction.
class PathModel {
  public:
    static constexpr int kMaxSamples = 1024;  // samples of a tile
    // Shading points that are lit together: those of as many samples, and what the last packet of them has more where a pixel
    // sees several surfaces of a coverage map.
    static constexpr int kMaxShadingPoints = kMaxSamples + 2 * kPacketSize;

    virtual ~PathModel() = default;

    // Adds to the tile's pixels what its rays see.
    virtual void trace(Tile& tile) = 0;
    // Makes all that tracing so deep needs; more is made by trace() when a frame first asks for it.
    virtual void reserve_depth(int /*max_depth*/) {}
    // Its own directions can meet lamps that next-event estimation counts too; they are weighed then.
    virtual bool samples_lobes() const { return false; }
    // Its frames need light that is cached (indirect_cache.h).
    virtual bool uses_indirect_cache() const { return false; }
};

// The tile's edge [px] such that its samples fit a PathModel.
inline int tile_edge_px(int samples_per_axis) {
    for (const int edge : {32, 16, 8, 4, 2, 1})
        if (edge * edge * samples_per_axis * samples_per_axis <= PathModel::kMaxSamples) return edge;
    HILCAM_CHECK(!"samples_per_axis is at most 32");
    return 1;
}

}  // namespace hilcam
