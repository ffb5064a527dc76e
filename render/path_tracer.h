#pragma once
// Traces the light paths of one tile of pixels: primary rays, shadow rays to the Sun, and the recursion of
// equation (1)'s hemisphere integral, as waves of packets. Docs of what is modelled: renderer.h.

#include <cstdint>
#include <memory>

#include "render/frame_view.h"
#include "render/image.h"
#include "render/pixel_box.h"

namespace hilcam {

struct TileStats {
    std::uint64_t primary_rays = 0, shadow_rays = 0, secondary_rays = 0, object_hits = 0;

    TileStats& operator+=(const TileStats& other) {
        primary_rays += other.primary_rays, shadow_rays += other.shadow_rays;
        secondary_rays += other.secondary_rays, object_hits += other.object_hits;
        return *this;
    }
};

// The tile's edge [px] such that its samples fit a TileTracer.
int tile_edge_px(int samples_per_axis);

// Scratch memory for one thread and the code that uses it. One thread at a time; no allocation after
// construction.
class TileTracer {
  public:
    static constexpr int kMostSamples = 1024;

    TileTracer();
    ~TileTracer();
    TileTracer(TileTracer&&) noexcept;

    // Overwrites the tile in every plane of `radiance`.
    TileStats trace(const FrameView& frame, const PixelBox& tile, RadianceImage& radiance);
    // The primary and shadow rays alone, nothing shaded: what the frame costs bare Embree.
    TileStats trace_bare(const FrameView& frame, const PixelBox& tile);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace hilcam
