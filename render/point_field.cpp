#include "render/point_field.h"

#include <cmath>
#include <limits>

namespace hilcam {

PointField::PointField(const FrameView& frame, const WorldSnapshot& world)
    : frame_(frame), camera_from_world_(transposed(to_matrix(world.camera.world_from_body))) {
    // The farthest corner of the field; distortion may push any of the four out.
    least_cosine_ = 1;
    const ImageGeometry& g = frame.geometry;
    for (const int x : {-g.guard_px, g.width_px + g.guard_px})
        for (const int y : {-g.guard_px, g.height_px + g.guard_px})
            least_cosine_ = std::min(least_cosine_, normalized(g.direction_camera(x, y)).z);
}

bool PointField::sees(Vec3d dir) const {
    const Vec3d in_camera = camera_from_world_ * dir;
    if (in_camera.z < least_cosine_) return false;
    const Vec2d p = frame_.geometry.project_px(in_camera);
    const double x = p.x + frame_.geometry.guard_px, y = p.y + frame_.geometry.guard_px;
    return x >= 0 && y >= 0 && x < frame_.geometry.padded_width() && y < frame_.geometry.padded_height();
}

void PointField::add(Vec3d dir, double distance_m, const Spectrum& irradiance,
                     std::vector<PointSource>& points) const {
    if (!sees(dir)) return;
    const Vec2d p = frame_.geometry.project_px(camera_from_world_ * dir);
    const auto px = static_cast<int>(p.x + frame_.geometry.guard_px),
               py = static_cast<int>(p.y + frame_.geometry.guard_px);
    const PixelBox here{px, py, px + 1, py + 1};
    Spectrum seen = irradiance;
    if (frame_.may_see_body(here)) {
        if (frame_.background->hides_seen(dir, distance_m)) return;
        // The air between dims it; the air's own light is in the image already.
        Spectrum ignored;
        if (frame_.background->air()) frame_.background->add_bodies_seen(dir, seen, ignored);
    }
    if (frame_.object_mask->at(px, py)) {
        const Vec3f start = frame_.start_of(dir);
        const double until_m = distance_m - length(to_double(start) - frame_.camera_m);
        RayPacket ray;
        ray.count = 1;
        ray.set(0, start, to_float(dir), 0, static_cast<float>(until_m));
        if (until_m > 0 && frame_.scene->occluded(ray)) return;
    }
    points.push_back({{static_cast<float>(p.x), static_cast<float>(p.y)}, seen});
}

void PointField::add_stars(const std::vector<Star>& stars, std::vector<PointSource>& points) const {
    const Vec3d boresight = camera_from_world_.z;
    for (const Star& star : stars)
        if (dot(star.world_dir, boresight) >= least_cosine_)
            add(star.world_dir, std::numeric_limits<double>::infinity(), star.irradiance_w_m2_um, points);
}

}  // namespace hilcam
