#pragma once
// Puts points of the ground through hilcam's camera, lens and attitude, from what ISIS (DOI-USGS/ISIS3) and
// USGSCSM (DOI-USGS/usgscsm) know of a picture. Their quaternions, scalar first, take a vector's components in
// ICRF to those in the frame; hilcam's go back.

#include <cmath>
#include <numbers>

#include "render/vocabulary/attitude.h"
#include "render/vocabulary/image_geometry.h"
#include "render/vocabulary/pose.h"

namespace hilcam {

constexpr double kTarget_px = 0.01;  // from the ground to the picture

struct PublishedView {
    ImageGeometry geometry;
    Pose camera;
    Quat icrf_from_body;

    // Returns the direction of a point of the body, in the camera's axes.
    Vec3d direction_camera(Vec3d ground_body_m) const {
        const Vec3d ground_icrf_m = to_matrix(icrf_from_body) * ground_body_m;
        return transposed(to_matrix(camera.world_from_body)) * (ground_icrf_m - camera.position_world_m);
    }
    Vec2d place_px(Vec3d ground_body_m) const { return geometry.project_px(direction_camera(ground_body_m)); }
};

inline ImageGeometry pinhole(int width_px, int height_px, double focal_length_px) {
    ImageGeometry out;
    out.width_px = width_px, out.height_px = height_px, out.focal_length_px = focal_length_px;
    return out;
}

// The point of an ellipsoid at a planetocentric latitude and longitude.
inline Vec3d on_ellipsoid(Vec3d half_axes_m, double latitude_deg, double longitude_deg) {
    constexpr double kDegree = std::numbers::pi / 180;
    const double lat = latitude_deg * kDegree, lon = longitude_deg * kDegree;
    const Vec3d d{std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat)};
    const Vec3d scaled{d.x / half_axes_m.x, d.y / half_axes_m.y, d.z / half_axes_m.z};
    return d / length(scaled);
}

}  // namespace hilcam
