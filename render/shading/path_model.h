#pragma once
// A path model follows light behind the surfaces that the camera sees. It is one of the program's
// exchangeable models.
//
//     direct   the surfaces that the camera sees, lit by the Sun; nothing else
//     cached   light between surfaces and from bodies out of the cache (indirect_cache.h), rays for mirrors;
//              random paths where nothing is cached
//     path     random paths with next-event estimation, multiple importance sampling and Russian roulette
// A path ends when it leaves the scene, when it can no longer add contribution_threshold, or after max_depth
// surfaces.

#include <memory>

#include "render/shading/tile.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/image.h"

namespace hilcam {

// A model with its scratch memory, for one thread at a time. No allocation after construction.
class PathModel {
  public:
    static constexpr int kMaxSamples = 1024;  // largest number of samples in a tile
    // The largest number of shading points that are lit together: one for each sample, and the surplus of the
    // last packet when pixels see several surfaces of a coverage map.
    static constexpr int kMaxShadingPoints = kMaxSamples + 2 * kPacketSize;

    virtual ~PathModel() = default;

    // Adds the light that the tile's rays see to its pixels.
    virtual void trace(Tile& tile) = 0;
    // Allocates what tracing to this depth needs. trace() allocates more when a frame first goes deeper.
    virtual void reserve_depth(int /*max_depth*/) {}
    // True when its paths can meet lamps that next-event estimation counts too; both are then weighted.
    virtual bool samples_lobes() const { return false; }
    // True when its frames need cached light (indirect_cache.h).
    virtual bool uses_indirect_cache() const { return false; }
};

// Returns the tile's edge [px] for which all samples fit a PathModel.
inline int tile_edge_px(int samples_per_axis) {
    for (const int edge : {32, 16, 8, 4, 2, 1})
        if (edge * edge * samples_per_axis * samples_per_axis <= PathModel::kMaxSamples) return edge;
    HILCAM_CHECK(!"samples_per_axis is at most 32");
    return 1;
}

}  // namespace hilcam
