#include "render/shading/point_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/shading/shadow_rays.h"
#include "render/vocabulary/units.h"

namespace hilcam {

PointField::PointField(const FrameContext& frame, const WorldSnapshot& world)
    : frame_(frame),
      world_(world),
      boresight_dir_(to_matrix(world.camera.world_from_body) * Vec3d{0, 0, 1}),
      field_rad_(std::min(kPi, half_field_rad(frame.geometry) + frame.rays->sweep_rad())),
      min_cosine_(std::cos(field_rad_)),
      lifted_rad_(frame.may_see_body({0, 0, frame.geometry.padded_width(), frame.geometry.padded_height()})
                      ? frame.background->max_turn_rad()
                      : 0) {}

double half_field_rad(const ImageGeometry& g) {
    // Distortion may move any of the four corners outwards.
    double farthest_rad = 0;
    for (const int x : {-g.guard_px, g.width_px + g.guard_px})
        for (const int y : {-g.guard_px, g.height_px + g.guard_px}) {
            const Vec3d d = g.direction_camera(x, y);
            farthest_rad = std::max(farthest_rad, std::atan2(std::hypot(d.x, d.y), d.z));
        }
    // Plus a rounding: a direction on the corner is in the image.
    return farthest_rad + 1e-9;
}

StarObserver PointField::observer_of(TimeTai star_time) const {
    constexpr double kJulianYear_s = 365.25 * 86400;
    const StateVector& origin = world_.bodies.origin_from_barycenter;
    return {static_cast<double>(world_.time - star_time) * kSecondsPerNs / kJulianYear_s,
            origin.position_m + world_.camera.position_world_m,
            origin.velocity_m_s + world_.shifting_velocity_m_s()};
}

bool PointField::find(Vec3d dir, double distance_m, Sighting& seen) const {
    // Parallax shifts near things; only for distant ones the direction alone decides.
    if (std::isinf(distance_m) && dot(dir, boresight_dir_) < min_cosine_) return false;
    if (!frame_.rays->find(dir, distance_m, seen)) return false;
    const ImageGeometry& g = frame_.geometry;
    const double x = seen.position_px.x + g.guard_px, y = seen.position_px.y + g.guard_px;
    return x >= 0 && y >= 0 && x < g.padded_width() && y < g.padded_height();
}

void PointField::push(const Sighting& seen, const PointSource& point,
                      std::vector<PointSource>& points) const {
    const auto add = [&](double y_px, double light_ratio) {
        points.push_back(point);
        points.back().position_px = {static_cast<float>(seen.position_px.x), static_cast<float>(y_px)};
        points.back().irradiance_w_m2_um = static_cast<float>(light_ratio) * point.irradiance_w_m2_um;
    };
    // A hundredth of a row more is not a streak.
    const auto rows = static_cast<std::size_t>(std::ceil(std::max(0.0, seen.light_ratio - 0.01)));
    if (rows <= 1 || points.capacity() - points.size() < rows)
        return add(seen.position_px.y, seen.light_ratio);
    // The sensor's row, one pixel high, becomes light_ratio rows; the point's own pixel is one of them.
    const auto n = static_cast<double>(rows);
    for (std::size_t i = 0; i < rows; ++i) {
        const double y_px =
            seen.position_px.y + (seen.light_ratio - 1) * ((static_cast<double>(i) + 0.5) / n - 0.5);
        if (y_px >= -frame_.geometry.guard_px && y_px < frame_.geometry.height_px + frame_.geometry.guard_px)
            add(y_px, seen.light_ratio / n);
    }
}

bool PointField::look(Vec3d dir, double distance_m, const Spectrum& irradiance, Sighting& sighting,
                      Spectrum& seen) const {
    if (!find(dir, distance_m, sighting)) return false;
    const auto px = static_cast<int>(sighting.position_px.x + frame_.geometry.guard_px),
               py = static_cast<int>(sighting.position_px.y + frame_.geometry.guard_px);
    const PixelBox here{px, py, px + 1, py + 1};
    seen = irradiance;
    if (frame_.may_see_body(here)) {
        if (frame_.background->hides_seen(dir, distance_m)) return false;
        // The air in between dims it; the air's own light is already in the image.
        Spectrum ignored;
        if (frame_.background->air()) frame_.background->add_bodies_seen(dir, seen, ignored);
    }
    if (frame_.object_mask->at(px, py)) {
        const bool far = std::isinf(distance_m);
        const Vec3d from_m = sighting.from_camera_m;
        const Vec3d to_thing_m = far ? dir : distance_m * dir - from_m;
        const double away_m = far ? distance_m : length(to_thing_m);
        const Vec3d thing_dir = normalized(to_thing_m);
        const Vec3f start = frame_.start_of(thing_dir, from_m);
        const double until_m = away_m - length(to_double(start) - (frame_.camera_m + from_m));
        RayPacket ray;
        ray.count = 1;
        ray.set(0, start, to_float(thing_dir), 0, static_cast<float>(until_m));
        if (until_m > 0 && frame_.scene->occluded(ray)) {
            if (!frame_.has_glass) return false;
            seen = seen * passed_through_glass(frame_, start, to_float(thing_dir), ray.farthest[0]);
            if (!(max_component(seen) > 0)) return false;
        }
    }
    return true;
}

void PointField::add(Vec3d dir, double distance_m, const Spectrum& irradiance,
                     std::vector<PointSource>& points, std::uint32_t object) const {
    Sighting sighting;
    Spectrum seen;
    if (look(dir, distance_m, irradiance, sighting, seen)) push(sighting, {{}, {}, object, seen}, points);
}

void PointField::add_from_sky(Vec3d dir, double distance_m, const Spectrum& irradiance,
                              std::vector<PointSource>& points, std::uint32_t thing) const {
    const AirRefraction::Seen seen = frame_.background->seen_through_air(dir, distance_m);
    add(seen.dir, distance_m, seen.light == 1 ? irradiance : static_cast<float>(seen.light) * irradiance,
        points, thing);
}

void PointField::add_stars(const StarSky& stars, std::vector<PointSource>& points) const {
    each_star(stars, [&](const Star& star, Vec3d dir) {
        add_from_sky(dir, std::numeric_limits<double>::infinity(), star.irradiance_w_m2_um, points);
    });
}

}  // namespace hilcam
