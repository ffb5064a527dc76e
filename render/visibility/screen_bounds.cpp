#include "render/visibility/screen_bounds.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// A box that grows with directions and becomes pixels at the end.
class Bounds {
  public:
    explicit Bounds(const ImageGeometry& geometry) : geometry_(geometry) {}

    void add(Vec3d direction_camera) {
        // At or behind the camera's plane there is no projection.
        if (!(direction_camera.z > 1e-9 * length(direction_camera))) {
            unbounded_ = true;
            return;
        }
        const Vec2d p = geometry_.project_px(direction_camera);
        least_ = {std::min(least_.x, p.x), std::min(least_.y, p.y)};
        most_ = {std::max(most_.x, p.x), std::max(most_.y, p.y)};
    }
    PixelBox box(double margin_px) const {
        const int width = geometry_.padded_width();
        const int height = geometry_.padded_height();
        const auto clamp = [&](double value, int size) {
            return static_cast<int>(std::clamp(value + geometry_.guard_px, 0.0, static_cast<double>(size)));
        };
        return {clamp(std::floor(least_.x - margin_px), width),
                clamp(std::floor(least_.y - margin_px), height), clamp(std::ceil(most_.x + margin_px), width),
                clamp(std::ceil(most_.y + margin_px), height)};
    }
    bool unbounded() const { return unbounded_; }
    double extent_px() const { return std::max(most_.x - least_.x, most_.y - least_.y); }

  private:
    const ImageGeometry& geometry_;
    Vec2d least_{1e300, 1e300};
    Vec2d most_{-1e300, -1e300};
    bool unbounded_ = false;
};

double angle_between(Vec3d a_dir, Vec3d b_dir) { return std::acos(std::clamp(dot(a_dir, b_dir), -1.0, 1.0)); }

// Returns bounds of a cone that is partly not in front of the camera: those of all cells of the picture that
// it can reach.
PixelBox bounds_by_cells(const ImageGeometry& geometry, Vec3d axis_camera, double cosine) {
    constexpr int kCells = 8;  // along each side
    // Without distortion no direction in a cell is farther from its middle than its corners are, because its
    // sides are great circles. A lens bends the sides; for supported lenses by less than a tenth (the test
    // has barrels and a fisheye).
    constexpr double kCurved = 1.1;
    const auto direction = [&](double x_px, double y_px) {
        return normalized(geometry.direction_camera(x_px - geometry.guard_px, y_px - geometry.guard_px));
    };
    const double reach_rad = std::acos(std::clamp(cosine, -1.0, 1.0)) + 2 / geometry.focal_length_px;
    PixelBox out{geometry.padded_width(), geometry.padded_height(), 0, 0};
    for (int i = 0; i < kCells * kCells; ++i) {
        const auto line = [](int cell, int size_px) { return cell * size_px / kCells; };
        const int column = i % kCells, row = i / kCells;
        const PixelBox cell{line(column, geometry.padded_width()), line(row, geometry.padded_height()),
                            line(column + 1, geometry.padded_width()),
                            line(row + 1, geometry.padded_height())};
        const Vec3d middle = direction(0.5 * (cell.x0 + cell.x1), 0.5 * (cell.y0 + cell.y1));
        double radius_rad = 0;
        for (const int x : {cell.x0, cell.x1})
            for (const int y : {cell.y0, cell.y1})
                radius_rad = std::max(radius_rad, angle_between(middle, direction(x, y)));
        if (angle_between(middle, axis_camera) > reach_rad + kCurved * radius_rad) continue;
        out = {std::min(out.x0, cell.x0), std::min(out.y0, cell.y0), std::max(out.x1, cell.x1),
               std::max(out.y1, cell.y1)};
    }
    return out.empty() ? PixelBox{} : out;
}

}  // namespace

PixelBox screen_bounds_of_cone(const ImageGeometry& geometry, const Pose& camera, Vec3d axis_world,
                               double cosine) {
    const Mat3d camera_from_world = transposed(to_matrix(camera.world_from_body));
    const Vec3d axis = camera_from_world * axis_world;
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    // The whole cone is behind the camera, so nothing is visible. Its direction nearest to +z is at
    // `angle(axis, z) - half angle`.
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
    if (bounds.unbounded()) return bounds_by_cells(geometry, axis, cosine);
    // A chord of the 64-gon deviates from the curve by 1 - cos(pi/64) = 0.0012 of the radius; the cone's
    // image is a conic.
    return bounds.box(1 + 0.003 * bounds.extent_px());
}

}  // namespace hilcam
