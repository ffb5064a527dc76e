#include "render/visibility/screen_bounds.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Grows with directions; turns into pixels at the end.
class Bounds {
  public:
    explicit Bounds(const ImageGeometry& geometry) : geometry_(geometry) {}

    void add(Vec3d direction_camera) {
        // At or behind the image's plane at infinity there is no projection; be safe and take all.
        if (!(direction_camera.z > 1e-9 * length(direction_camera))) {
            everywhere_ = true;
            return;
        }
        const Vec2d p = geometry_.project_px(direction_camera);
        least_ = {std::min(least_.x, p.x), std::min(least_.y, p.y)};
        most_ = {std::max(most_.x, p.x), std::max(most_.y, p.y)};
    }
    PixelBox box(double margin_px) const {
        const int width = geometry_.padded_width();
        const int height = geometry_.padded_height();
        if (everywhere_) return {0, 0, width, height};
        const auto clamp = [&](double value, int size) {
            return static_cast<int>(std::clamp(value + geometry_.guard_px, 0.0, static_cast<double>(size)));
        };
        return {clamp(std::floor(least_.x - margin_px), width),
                clamp(std::floor(least_.y - margin_px), height), clamp(std::ceil(most_.x + margin_px), width),
                clamp(std::ceil(most_.y + margin_px), height)};
    }
    double extent_px() const { return everywhere_ ? 0 : std::max(most_.x - least_.x, most_.y - least_.y); }

  private:
    const ImageGeometry& geometry_;
    Vec2d least_{1e300, 1e300};
    Vec2d most_{-1e300, -1e300};
    bool everywhere_ = false;
};

}  // namespace

PixelBox screen_bounds_of_cone(const ImageGeometry& geometry, const Pose& camera, Vec3d axis_world,
                               double cosine) {
    const Mat3d camera_from_world = transposed(to_matrix(camera.world_from_body));
    const Vec3d axis = camera_from_world * axis_world;
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    // The whole cone behind the camera: nothing to see. Its nearest direction to +z is `angle(axis, z) - half
    // angle`.
    if (axis.z < 0 && -axis.z > sine) return {};
    const Vec3d across =
        normalized(std::abs(axis.x) < 0.7 ? cross(axis, Vec3d{1, 0, 0}) : cross(axis, Vec3d{0, 1, 0}));
    const Vec3d up = cross(axis, across);
    Bounds bounds(geometry);
    constexpr int kPoints = 64;
    for (int i = 0; i < kPoints; ++i) {
        const double a = 2 * kPi * i / kPoints;
        bounds.add(cosine * axis + sine * (std::cos(a) * across + std::sin(a) * up));
    }
    // A chord of the 64-gon leaves the curve by 1 - cos(pi/64) = 0.0012 of the radius; the cone's image is a
    // conic.
    return bounds.box(1 + 0.003 * bounds.extent_px());
}

}  // namespace hilcam
