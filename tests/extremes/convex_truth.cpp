#include "tests/extremes/convex_truth.h"

#include <algorithm>

#include "render/frame/plan.h"

namespace hilcam::extremes {

void ConvexSum::add(std::span<const Vec3d> corners_m, double radiance) {
    const ImageGeometry& g = stage_.geometry;
    const Mat3d camera_from_world = transposed(to_matrix(stage_.world.camera.world_from_body));
    std::vector<Vec2d> p;
    for (const Vec3d& corner : corners_m) p.push_back(g.project_px(camera_from_world * corner));
    // Shoelace formula about the first corner, which keeps its digits where the polygon is tiny.
    double area = 0, x = 0, y = 0, edges_px = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec2d next = p[(i + 1) % p.size()];
        edges_px += std::hypot(next.x - p[i].x, next.y - p[i].y);
        const double ax = p[i].x - p[0].x, ay = p[i].y - p[0].y, bx = next.x - p[0].x, by = next.y - p[0].y;
        const double part = 0.5 * (ax * by - ay * bx);
        area += part, x += part * (ax + bx) / 3, y += part * (ay + by) / 3;
    }
    const double per_px2 = radiance / (g.focal_length_px * g.focal_length_px);
    const double amount = per_px2 * std::abs(area);
    irradiance_ += amount;
    x_ += amount * (p[0].x + x / area), y_ += amount * (p[0].y + y / area);
    variance_ += per_px2 * per_px2 * std::pow(step_px_, 3) * edges_px / 12;
    corners_px_.insert(corners_px_.end(), p.begin(), p.end());
}

ConvexTruth ConvexSum::truth() const {
    ConvexTruth out;
    out.irradiance = irradiance_;
    out.centroid_px = {x_ / irradiance_, y_ / irradiance_};
    out.flux_sigma = std::sqrt(variance_) / irradiance_;
    double farthest_px = 0;
    for (const Vec2d& p : corners_px_)
        farthest_px = std::max(farthest_px, std::hypot(p.x - out.centroid_px.x, p.y - out.centroid_px.y));
    out.centroid_sigma_px = farthest_px * out.flux_sigma;
    return out;
}

ConvexTruth cube_truth(const Stage& s, double size_m, double albedo) {
    ConvexSum sum(s, ray_step_px(s, std::sqrt(0.75) * size_m));
    const Pose& object = s.world.objects[0];
    const Mat3d m = to_matrix(object.world_from_body);
    const Vec3d sun = normalized(s.world.bodies.sun_world_m - object.position_world_m);
    const Vec3d offset = object.position_world_m - s.world.camera.position_world_m;
    const std::array<Vec3d, 3> axes = {transposed(m).x, transposed(m).y, transposed(m).z};
    for (std::size_t k = 0; k < 3; ++k)
        for (const double sign : {-1.0, 1.0}) {
            const Vec3d n = sign * axes[k], u = axes[(k + 1) % 3], v = axes[(k + 2) % 3];
            const Vec3d middle = offset + 0.5 * size_m * n;
            if (dot(n, middle) >= 0 || dot(n, sun) <= 0) continue;
            std::array<Vec3d, 4> corners;
            const std::array<Vec2d, 4> signs = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
            for (std::size_t i = 0; i < 4; ++i)
                corners[i] = middle + 0.5 * size_m * (signs[i].x * u + signs[i].y * v);
            sum.add(corners, albedo * kSun_w_m2_um * dot(n, sun) / kPi);
        }
    return sum.truth();
}

ConvexTruth triangle_truth(const Stage& s, std::span<const Vec3d, 3> corners_m, double albedo) {
    double radius_m = 0;
    for (const Vec3d& c : corners_m) radius_m = std::max(radius_m, length(c));
    ConvexSum sum(s, ray_step_px(s, radius_m));
    const Pose& object = s.world.objects[0];
    const Vec3d offset = object.position_world_m - s.world.camera.position_world_m;
    const Vec3d sun = normalized(s.world.bodies.sun_world_m - object.position_world_m);
    std::array<Vec3d, 3> corners;
    for (std::size_t i = 0; i < 3; ++i)
        corners[i] = offset + to_matrix(object.world_from_body) * corners_m[i];
    const Vec3d normal = normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
    // Either side shows, if the Sun is on the camera's.
    const bool lit = (dot(normal, sun) > 0) == (dot(normal, corners[0]) < 0);
    if (lit) sum.add(corners, albedo * kSun_w_m2_um * std::abs(dot(normal, sun)) / kPi);
    return sum.truth();
}

double ray_step_px(const Stage& s, double radius_m) {
    const ObjectPlan plan =
        plan_object(s.geometry, s.world, s.world.objects[0], radius_m,
                    {static_cast<int>(s.quality.samples_per_axis), static_cast<int>(s.quality.rays_across)});
    // Points: a picture of its own, as wide as the sphere and 2 % more (impostor_camera.cpp).
    if (plan.use == ObjectUse::kPoints)
        return 1.02 * plan.size_px / static_cast<double>(s.quality.point_samples);
    return 1.0 / plan.samples_per_axis;
}

double grain_px(const Stage& s, double radius_m) {
    const double distance_m = length(s.world.objects[0].position_world_m - s.world.camera.position_world_m);
    const double across_px = 2 * radius_m / distance_m * s.geometry.focal_length_px;
    // Two roundings of a direction of length 1 or little more, where rays begin at the camera; where they
    // begin at the object, of a start within its sphere and of a direction over its depth.
    const double ray_px = distance_m < 20 * radius_m ? s.geometry.focal_length_px : across_px;
    return 4 * kFloatGrain * ray_px + kFloatGrain * s.geometry.width_px +
           8 * kDoubleGrain * s.geometry.focal_length_px;
}

std::vector<Found> compared(const Stage& s, const ConvexTruth& truth) {
    const Stage::Light seen = s.light();
    Worst flux, centroid;
    flux.add(relative(seen.irradiance, truth.irradiance));
    for (const float value : s.radiance.all())
        if (!(value >= 0)) flux.add(NAN);
    centroid.add(std::abs(seen.centroid_px.x - truth.centroid_px.x));
    centroid.add(std::abs(seen.centroid_px.y - truth.centroid_px.y));
    return {{truth.irradiance, flux.value()}, {truth.centroid_px.x, centroid.value()}};
}

std::vector<double> limits_of(const Stage& s, const ConvexTruth& truth, double radius_m) {
    // Single precision: eight roundings of the radiance, and the outline's own grain along its whole length.
    const double distance_m = length(s.world.objects[0].position_world_m - s.world.camera.position_world_m);
    const double across_px = 2 * radius_m / distance_m * s.geometry.focal_length_px;
    const double grain = grain_px(s, radius_m);
    return {kSigmas * truth.flux_sigma + 8 * kFloatGrain + 4 * grain / std::max(across_px, 1.0),
            kSigmas * truth.centroid_sigma_px + grain};
}

}  // namespace hilcam::extremes
