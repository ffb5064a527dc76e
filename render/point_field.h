#pragma once
// Things smaller than a pixel become point sources where nothing is before them: stars, far planets, far
// objects.

#include <vector>

#include "render/frame_view.h"
#include "render/point_source.h"
#include "render/scene.h"

namespace hilcam {

// For one frame. With rows of different instants all points are at the frame's own. Loop; no allocation while
// the vector has room.
class PointField {
  public:
    PointField(const FrameView& frame, const WorldSnapshot& world);

    void add_stars(const std::vector<Star>& stars, std::vector<PointSource>& points) const;
    // A thing at a distance [m] in a direction (unit, world) with this irradiance at the camera.
    void add(Vec3d dir, double distance_m, const Spectrum& irradiance_w_m2_um,
             std::vector<PointSource>& points) const;
    // Whether the direction is in the padded image.
    bool sees(Vec3d dir) const;

  private:
    const FrameView& frame_;
    Mat3d camera_from_world_;
    double least_cosine_;
};

}  // namespace hilcam
