#pragma once
// From what a pixel sees to what one of its samples sees: the direction through a place in a pixel, and the way to it in the plane of
// a shading point or of a cluster.

#include "render/shading/tile.h"

namespace hilcam {

// Returns the direction through a place in a pixel, as the frame's visibility buffer has it; world axes, of any length.
Vec3d direction_seen(const FrameContext& frame, int x_px, int y_px, Vec2f within_px);
// The same by the camera's own rays, where these are linear.
Vec3d direction_through(const FrameContext& frame, int x_px, int y_px, Vec2f within_px);
// Returns the place from which the camera sees a row of pixels [ray space].
Vec3d eye_m(const FrameContext& frame, int y_px);

// The ways from a shading point that samples see to where each of them meets its plane, and up by ShadingPoint::lift_m [m, ray
// space]; none where the plane is seen from its edge. Loop, any thread.
class SampleOffsets {
  public:
    SampleOffsets(const Tile& tile, const ShadingPoint& at);
    // sample: one of ShadingPoint::samples.
    Vec3f to(int sample) const;
    // Returns where a sample meets the plane in which rays from a cluster of the shading point begin [ray space]; where that is
    // seen from its edge, the cluster's own start.
    Vec3f on(const NormalCluster& cluster, int sample) const;

  private:
    const FrameContext& frame_;
    const ShadingPoint& at_;
    int x_px_, y_px_;
    Vec3d eye_m_;
    float facing_;  // cosine of the plane's normal to the viewer
    Vec3d dir_;     // through the shading point
    double per_dir_m_;
};

}  // namespace hilcam
