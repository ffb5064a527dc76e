#pragma once
// Finds what the last placed frame shows (frame_truth.h).

#include <cstddef>
#include <cstdint>
#include <span>

#include "render/frame/frame_setup.h"
#include "render/frame/frame_truth.h"
#include "render/frame/truth_rays.h"
#include "render/shading/point_field.h"

namespace hilcam {

// The largest number of stars in a frame's truth.
inline constexpr std::size_t kMaxTruthStars = 16384;

// Makes a record with room for everything that TruthProbe reports of this set-up's frames, up to a size.
// Owner thread.
FrameTruth make_truth(const FrameSetup& setup, const TruthRequest& request, int width_px, int height_px);

class TruthProbe {
  public:
    // Fills `truth`, which make_truth() made for this set-up; its raster is set. Loop: no allocation. Runs on
    // oneTBB; the result does not depend on the number of threads.
    TruthProbe(const FrameSetup& setup, FrameTruth& truth);
    void report();

  private:
    void report_sun_and_bodies();
    void report_objects();
    void report_stars();
    SeenThing described(std::uint32_t id, const Pose& world) const;
    SeenThing described(std::uint32_t id, const Pose& world, Vec3d from_camera_m) const;
    bool project(Vec3d from_camera_m, Vec2d& frame_px) const;

    void size_layers();
    void trace_pixels();
    void trace_block(int x0, int y0);
    PixelBox padded_box(int x0, int y0, int x1, int y1) const;
    bool can_see(const PixelBox& padded) const;
    void write(int x, int y, const RayMet& met);

    void count_pixels();
    SeenThing* thing_of(std::uint32_t id);

    const FrameSetup& setup_;
    const FrameContext& frame_;
    const WorldSnapshot& world_;
    FrameTruth& truth_;
    TruthRays rays_;
    Mat3d camera_from_world_;
};

}  // namespace hilcam
