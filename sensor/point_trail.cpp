#include "sensor/point_trail.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/vocabulary/pose.h"

namespace hilcam {
namespace {

// Points of a trail per pixel. A row of points has its first harmonic at this frequency, where the transfer
// function of a full pixel is zero along both axes.
constexpr double kPerPixel = 2;

}  // namespace

void PointTrails::begin(const Exposure& exposure, double jitter_px) {
    jitter_px_ = jitter_px;
    weight_sum_ = 0;
    for (int i = -kSteps; i <= kSteps; ++i)
        weight_sum_ += weights_[static_cast<std::size_t>(i + kSteps)] = std::exp(-0.125 * i * i);
    turn_rad_ = -exposure.exposure_s * exposure.camera_rate_rad_s;
    turns_ = turn_rad_.x != 0 || turn_rad_.y != 0 || turn_rad_.z != 0;
    turn_px_ = view_.detector.distortion.none() ? view_.detector.focal_length_px * length(turn_rad_)
                                                : std::numeric_limits<double>::infinity();
    center_px_ = view_.detector.center_px();
    per_focal2_ = 1 / (view_.detector.focal_length_px * view_.detector.focal_length_px);
    at_start_ = to_matrix(from_rotation_vector(-0.5 * turn_rad_));
    at_end_ = to_matrix(from_rotation_vector(0.5 * turn_rad_));
}

// Returns 0 for a way that has no image.
int PointTrails::parts_of(Vec2d from_px, Vec2d to_px) {
    const double length_px = std::hypot(to_px.x - from_px.x, to_px.y - from_px.y);
    if (!std::isfinite(length_px)) return 0;
    return static_cast<int>(std::clamp(std::ceil(length_px * kPerPixel), 1.0, 4096.0));
}

PointTrails::Trail PointTrails::straight(Vec2d middle_px, Vec2d way_px) {
    const Vec2d half{0.5 * way_px.x, 0.5 * way_px.y};
    return {
        middle_px, way_px, false,
        parts_of({middle_px.x - half.x, middle_px.y - half.y}, {middle_px.x + half.x, middle_px.y + half.y})};
}

PointTrails::Trail PointTrails::of_sky(Vec2d middle_px, Vec2d drift_px) const {
    if (!turns_) return straight(middle_px, drift_px);
    if (stays_in_part(middle_px, drift_px)) return {middle_px, drift_px, true, 1};
    const Vec3d dir = view_.detector.direction_camera(middle_px.x, middle_px.y);
    const Vec2d from = turned_px(at_start_, dir), to = turned_px(at_end_, dir);
    const Vec2d half{0.5 * drift_px.x, 0.5 * drift_px.y};
    return {middle_px, drift_px, true,
            parts_of({from.x - half.x, from.y - half.y}, {to.x + half.x, to.y + half.y})};
}

// True for most points in most exposures. A rotation by a small angle moves a point on the plane z = 1 by at
// most that angle times 1 + r^2, with r the greatest distance from the axis on its way. Not used for lenses
// that bend straight lines (begin()).
bool PointTrails::stays_in_part(Vec2d middle_px, Vec2d drift_px) const {
    constexpr double kFarther = 0.1, kLess = 0.99;
    const double x_px = middle_px.x - center_px_.x, y_px = middle_px.y - center_px_.y;
    const double r2 = (x_px * x_px + y_px * y_px) * per_focal2_;
    const double farthest2 = 1 + 2 * (r2 + kFarther * kFarther);  // (a + b)^2 is at most 2 a^2 + 2 b^2
    const double way_px = turn_px_ * farthest2;
    return way_px < kFarther * view_.detector.focal_length_px &&
           way_px + std::abs(drift_px.x) + std::abs(drift_px.y) < kLess / kPerPixel;
}

Vec2d PointTrails::turned_px(const Mat3d& turn, Vec3d dir) const {
    const Vec3d moved = turn * dir;
    return moved.z > 0 ? view_.detector.project_px(moved) : Vec2d{-1e9, -1e9};
}

Vec2d PointTrails::place(const Trail& trail, int part) const {
    if (trail.parts == 1) return trail.middle_px;
    const double time = (part + 0.5) / trail.parts - 0.5;
    Vec2d px = trail.middle_px;
    if (trail.turns && time != 0) {
        const Vec3d dir = view_.detector.direction_camera(px.x, px.y);
        px = turned_px(to_matrix(from_rotation_vector(time * turn_rad_)), dir);
    }
    return {px.x + time * trail.drift_px.x, px.y + time * trail.drift_px.y};
}

Vec2d PointTrails::scattered_px(Vec2d place_px, std::size_t k) const {
    if (jitter_px_ <= 0) return place_px;
    const int i = static_cast<int>(k % kAcross) - kSteps, j = static_cast<int>(k / kAcross) - kSteps;
    return {place_px.x + 0.5 * i * jitter_px_, place_px.y + 0.5 * j * jitter_px_};
}

double PointTrails::share(std::size_t k) const {
    if (jitter_px_ <= 0) return 1;
    return weights_[k % kAcross] * weights_[k / kAcross] / (weight_sum_ * weight_sum_);
}

}  // namespace hilcam
