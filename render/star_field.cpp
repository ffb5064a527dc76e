#include "render/star_field.h"

#include <cmath>
#include <limits>

namespace hilcam {

void add_stars(const std::vector<Star>& stars, const FrameView& frame, std::vector<PointSource>& points) {
    const ImageGeometry& geometry = frame.geometry;
    const Mat3d camera_from_world = transposed(frame.world_from_camera);
    const Vec3d boresight = camera_from_world.z;
    const Vec3d corner = normalized(geometry.direction_camera(-geometry.guard_px, -geometry.guard_px));
    const double least_cosine = corner.z;
    const Spectrum nothing;
    Spectrum ignored;

    RayPacket ray;
    ray.count = 1;
    for (const Star& star : stars) {
        if (dot(star.world_dir, boresight) < least_cosine) continue;
        const Vec2d p = geometry.project_px(camera_from_world * star.world_dir);
        const double x = p.x + geometry.guard_px;
        const double y = p.y + geometry.guard_px;
        if (x < 0 || y < 0 || x >= geometry.padded_width() || y >= geometry.padded_height()) continue;
        const auto px = static_cast<int>(x);
        const auto py = static_cast<int>(y);
        const PixelBox here{px, py, px + 1, py + 1};
        if (here.overlaps(frame.earth_box) &&
            frame.background->add_earth({0, 0, 0}, star.world_dir, nothing, ignored))
            continue;
        if (frame.object_mask->at(px, py)) {
            ray.set(0, {0, 0, 0}, to_float(star.world_dir), 0, std::numeric_limits<float>::infinity());
            if (frame.scene->occluded(ray)) continue;
        }
        points.push_back({{static_cast<float>(p.x), static_cast<float>(p.y)}, star.irradiance_w_m2_um});
    }
}

}  // namespace hilcam
