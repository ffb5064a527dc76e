#pragma once
// Traces the light paths of one tile of pixels: primary rays, shadow rays to the Sun, and the recursion of
// equation (1)'s hemisphere integral, as waves of packets. Docs of what is modelled: renderer.h.

#include <cstdint>
#include <vector>

#include "render/background.h"
#include "render/embree_scene.h"
#include "render/image.h"
#include "render/pixel_box.h"
#include "render/random.h"
#include "render/ray_generator.h"
#include "render/screen_mask.h"
#include "render/surface.h"

namespace hilcam {

// What one frame's tiles share. Constant while they are traced.
struct FrameView {
    const EmbreeScene* scene = nullptr;
    const std::vector<ObjectSurfaces>* objects = nullptr;
    std::vector<Mat3f> world_from_body;       // per object
    const ScreenMask* object_mask = nullptr;  // pixels that can meet an object
    const Background* background = nullptr;
    const ColorBands* bands = nullptr;
    ImageGeometry geometry;
    Mat3d world_from_camera;
    // The direction through the corner of padded pixel (0, 0), and what a pixel to the right or down adds.
    Vec3d corner_world_dir, right_world_dir, down_world_dir;
    int bins = 0;
    int samples_per_axis = 1;
    int max_depth = 1;
    float contribution_threshold = 0;
    float samples() const { return static_cast<float>(samples_per_axis * samples_per_axis); }
    RandomKey key;
    bool earth_may_hide = false;  // an object is so far away that the Earth can stand before it
    PixelBox earth_box;           // pixels that can meet the Earth
    PixelBox sun_box;             // pixels that can meet the Sun's disk
};

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
