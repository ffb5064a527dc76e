#include "io/images/sky_map.h"

#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {

SkyMap sky_map(const Pose& camera, const CameraModel& model, const PictureLayout& layout) {
    constexpr double kDegrees = 180 / kPi;
    const Mat3d world_from_camera = to_matrix(camera.world_from_body);
    const Vec3d right = world_from_camera * Vec3d{1, 0, 0}, down = world_from_camera * Vec3d{0, 1, 0},
                ahead = world_from_camera * Vec3d{0, 0, 1};
    const double ra = std::atan2(ahead.y, ahead.x);
    const double dec = std::atan2(ahead.z, std::hypot(ahead.x, ahead.y));
    const Vec3d east{-std::sin(ra), std::cos(ra), 0};
    const Vec3d north{-std::sin(dec) * std::cos(ra), -std::sin(dec) * std::sin(ra), std::cos(dec)};
    const FrameIntrinsics lens = lens_of(model, layout);

    SkyMap map;
    map.fisheye = model.projection == Projection::kFisheye;
    map.ra_deg = (ra < 0 ? ra + 2 * kPi : ra) * kDegrees;
    map.dec_deg = dec * kDegrees;
    // hilcam has the first pixel's centre at (0.5, 0.5).
    map.reference_px = {lens.principal_point_px.x + 0.5, lens.principal_point_px.y + 0.5};
    const double per_x = kDegrees / lens.focal_length_px.x, per_y = kDegrees / lens.focal_length_px.y;
    map.east_deg_px[0] = per_x * dot(right, east), map.east_deg_px[1] = per_y * dot(down, east);
    map.north_deg_px[0] = per_x * dot(right, north), map.north_deg_px[1] = per_y * dot(down, north);
    return map;
}

}  // namespace hilcam
