#include "emulator/tradeoff/limb_error.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kStep_px = 0.25;
constexpr std::size_t kSamples = static_cast<std::size_t>(2 * kLimbReach_px / kStep_px) + 1;
// Candidates on the whole limb: enough for a narrow field that contains a thousandth of it.
constexpr int kCandidates = 65536;
constexpr std::size_t kMaxPoints = 512, kMinPoints = 8;

// The limb of a body, seen by the camera.
class Limb {
  public:
    Limb(const BodyState& body, const Figure& figure, const Pose& camera)
        : figure_(figure),
          camera_from_fixed_(transposed(to_matrix(camera.world_from_body)) *
                             transposed(body.fixed_from_world)),
          camera_m_(body.fixed_from_world * (camera.position_world_m - body.world_m)) {
        const double a = figure.equatorial_radius_m;
        const Vec3d stretched{camera_m_.x, camera_m_.y, camera_m_.z * stretch()};
        const double distance = length(stretched);
        outside_ = distance > a;
        if (!outside_) return;
        // The centre of the circle on which rays touch the sphere.
        middle_m_ = (a * a / (distance * distance)) * stretched;
        radius_m_ = a * std::sqrt((1 - a / distance) * (1 + a / distance));
        const Vec3d axis = stretched / distance;
        across_ =
            normalized(std::abs(axis.x) < 0.7 ? cross(axis, Vec3d{1, 0, 0}) : cross(axis, Vec3d{0, 1, 0}));
        up_ = cross(axis, across_);
    }
    bool outside() const { return outside_; }

    // Returns the direction from the camera to a place on the limb, in camera axes.
    Vec3d direction_camera(double angle_rad) const {
        const Vec3d p = middle_m_ + radius_m_ * (std::cos(angle_rad) * across_ + std::sin(angle_rad) * up_);
        return camera_from_fixed_ * (Vec3d{p.x, p.y, p.z / stretch()} - camera_m_);
    }
    bool hit_by(Vec3d direction_camera) const {
        return intersect_ellipsoid(figure_, camera_m_, transposed(camera_from_fixed_) * direction_camera) > 0;
    }

  private:
    double stretch() const { return figure_.equatorial_radius_m / figure_.polar_radius_m; }

    Figure figure_;
    Mat3d camera_from_fixed_;
    Vec3d camera_m_;  // body axes
    bool outside_ = false;
    Vec3d middle_m_, across_, up_;
    double radius_m_ = 0;
};

std::optional<Vec2d> in_view(const ImageGeometry& g, Vec3d direction_camera) {
    if (!(direction_camera.z > 0.01 * length(direction_camera))) return std::nullopt;
    const Vec2d p = g.project_px(direction_camera);
    // Samples are interpolated between pixel centres.
    constexpr double kMargin_px = kLimbReach_px + 1;
    const bool inside = p.x > kMargin_px && p.y > kMargin_px && p.x < g.width_px - kMargin_px &&
                        p.y < g.height_px - kMargin_px;
    if (!inside) return std::nullopt;
    // A strong lens distortion folds over far outside the field.
    const Vec3d back = g.direction_camera(p.x, p.y);
    if (length(normalized(back) - normalized(direction_camera)) * g.focal_length_px > 0.01)
        return std::nullopt;
    return p;
}

std::optional<LimbPlace> place_at(const Limb& limb, const ImageGeometry& g, double angle_rad) {
    const std::optional<Vec2d> p = in_view(g, limb.direction_camera(angle_rad));
    // A neighbour gives the tangent along the limb in the picture.
    const std::optional<Vec2d> q = in_view(g, limb.direction_camera(angle_rad + 1e-6));
    if (!p || !q) return std::nullopt;
    const Vec2d tangent{q->x - p->x, q->y - p->y};
    const double size = std::hypot(tangent.x, tangent.y);
    if (!(size > 0)) return std::nullopt;
    Vec2d normal{tangent.y / size, -tangent.x / size};
    if (limb.hit_by(g.direction_camera(p->x + normal.x, p->y + normal.y))) normal = {-normal.x, -normal.y};
    return LimbPlace{*p, normal};
}

using Profile = std::array<double, kSamples>;  // from the sky's end to the disk's

double bilinear(const ElectronImage& image, double x_px, double y_px) {
    const double x = x_px - 0.5, y = y_px - 0.5;
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const double u = x - x0, v = y - y0;
    const auto at = [&](int column, int row) {
        return static_cast<double>(image.row(row)[static_cast<std::size_t>(column)]);
    };
    return (1 - v) * ((1 - u) * at(x0, y0) + u * at(x0 + 1, y0)) +
           v * ((1 - u) * at(x0, y0 + 1) + u * at(x0 + 1, y0 + 1));
}

Profile profile_at(const ElectronImage& image, const LimbPlace& place, Vec2d offset_px) {
    Profile out;
    for (std::size_t i = 0; i < kSamples; ++i) {
        const double s = kLimbReach_px - kStep_px * static_cast<double>(i);
        out[i] = bilinear(image, offset_px.x + place.position_px.x + s * place.sky_dir.x,
                          offset_px.y + place.position_px.y + s * place.sky_dir.y);
    }
    return out;
}

// Means over the outermost quarters.
struct Ends {
    double sky_e = 0, disk_e = 0;
};
Ends ends_of(const Profile& profile) {
    constexpr std::size_t kEnd = kSamples / 4;
    Ends ends;
    for (std::size_t i = 0; i < kEnd; ++i) {
        ends.sky_e += profile[i] / kEnd;
        ends.disk_e += profile[kSamples - 1 - i] / kEnd;
    }
    return ends;
}

// Returns how far the profile goes inwards from the sky until it reaches a level [px]; its length if it never
// does.
double first_reach_px(const Profile& profile, double level_e) {
    for (std::size_t i = 0; i < kSamples; ++i) {
        if (profile[i] < level_e) continue;
        if (i == 0) return 0;
        const double share = (level_e - profile[i - 1]) / (profile[i] - profile[i - 1]);
        return kStep_px * (static_cast<double>(i - 1) + share);
    }
    return kStep_px * static_cast<double>(kSamples - 1);
}

}  // namespace

std::vector<LimbPlace> limb_places(const BodyState& body, const Figure& figure, const Pose& camera,
                                   const ImageGeometry& geometry) {
    const Limb limb(body, figure, camera);
    if (!limb.outside()) return {};
    std::vector<LimbPlace> seen;
    for (int i = 0; i < kCandidates; ++i)
        if (const auto place = place_at(limb, geometry, 2 * kPi * i / kCandidates)) seen.push_back(*place);
    if (seen.size() < kMinPoints) return {};
    std::vector<LimbPlace> out;
    const std::size_t count = std::min(kMaxPoints, seen.size());
    for (std::size_t i = 0; i < count; ++i) out.push_back(seen[i * seen.size() / count]);
    return out;
}

std::optional<LimbError> limb_error(const ElectronImage& image, const ElectronImage& reference,
                                    std::span<const LimbPlace> places, Vec2d offset_px, double min_step_e) {
    LimbError error;
    double squares = 0;
    for (const LimbPlace& place : places) {
        const Profile expected = profile_at(reference, place, offset_px);
        const Ends ends = ends_of(expected);
        if (!(ends.disk_e - ends.sky_e > min_step_e)) continue;
        const double level_e = 0.5 * (ends.sky_e + ends.disk_e);
        const double shift_px =
            first_reach_px(profile_at(image, place, offset_px), level_e) - first_reach_px(expected, level_e);
        squares += shift_px * shift_px;
        ++error.places;
    }
    if (error.places == 0) return std::nullopt;
    error.rms_px = std::sqrt(squares / error.places);
    return error;
}

}  // namespace hilcam
