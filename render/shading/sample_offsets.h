#pragma once
// From a shading point to what each of its samples sees: the direction through a place in the pixel, and the
// offset to where that direction meets the plane of the shading point or of a cluster.

#include "render/shading/tile.h"

namespace hilcam {

// Returns the direction through a place in a pixel as the frame's visibility buffer sees it; world axes, of
// any length.
Vec3d direction_seen(const FrameContext& frame, int x_px, int y_px, Vec2f within_px);
// Returns the same by the camera's own rays, which have to be linear.
Vec3d direction_through(const FrameContext& frame, int x_px, int y_px, Vec2f within_px);
// Returns the camera's position when it sees a row of pixels [ray space].
Vec3d eye_m(const FrameContext& frame, int y_px);

// For a shading point that several samples see: the offsets from it to where each sample meets its plane,
// raised by ShadingPoint::lift_m [m, ray space]. Zero if the plane is seen edge-on. Loop, any thread.
class SampleOffsets {
  public:
    SampleOffsets(const Tile& tile, const ShadingPoint& at);
    // sample: one of ShadingPoint::samples.
    Vec3f to(int sample) const;
    // Returns where a sample meets the plane in which rays from a cluster start [ray space]; if that plane is
    // seen edge-on, the cluster's own start.
    Vec3f on(const NormalCluster& cluster, int sample) const;

  private:
    const FrameContext& frame_;
    const ShadingPoint& at_;
    int x_px_, y_px_;
    Vec3d eye_m_;
    float facing_;  // cosine of the plane's normal to the viewer
    Vec3d dir_;     // to the shading point
    double per_dir_m_;
};

}  // namespace hilcam
