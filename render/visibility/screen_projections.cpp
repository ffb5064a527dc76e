#include "render/visibility/screen_projections.h"

#include <algorithm>

namespace hilcam {
namespace {

float single(double v) { return static_cast<float>(v); }

Vec2d center_of_padded(const ImageGeometry& g) {
    return {g.center_px().x + g.guard_px, g.center_px().y + g.guard_px};
}

// Returns the polynomial of second degree in u with these values at -1, 0 and 1, by powers of u.
std::array<Vec3f, 3> through(Vec3d first, Vec3d middle, Vec3d last) {
    return {to_float(middle), to_float(0.5 * (last - first)), to_float(0.5 * (first + last) - middle)};
}

}  // namespace

ScreenProjection screen_projection(const ImageGeometry& g, const InCamera& at, double radius_m,
                                   double depth_origin_m) {
    const Mat3d& axes = at.camera_from_body;
    const Vec3d& origin_m = at.origin_m;
    ScreenProjection p;
    p.axes = {to_float(axes.x), to_float(axes.y), to_float(axes.z)};
    p.distance = single(origin_m.z);
    p.beyond_origin = single(origin_m.z - depth_origin_m);
    p.focal_px = single(g.focal_length_px);
    const Vec2d center = center_of_padded(g);
    if (origin_m.z > 2 * radius_m) {
        // Relative to where the body's origin is seen: the rest is small and keeps its digits.
        const double lean_x = origin_m.x / origin_m.z, lean_y = origin_m.y / origin_m.z;
        p.offset_x = single(center.x + g.focal_length_px * lean_x), p.lean_x = single(-lean_x);
        p.offset_y = single(center.y + g.focal_length_px * lean_y), p.lean_y = single(-lean_y);
    } else {
        p.offset_x = single(center.x), p.start_x = single(origin_m.x);
        p.offset_y = single(center.y), p.start_y = single(origin_m.y);
    }
    return p;
}

RollingProjection rolling_projection(const ImageGeometry& g, const InRollingCamera& at,
                                     double depth_origin_m) {
    const auto row = [&](Vec3d Mat3d::*of) {
        return through(at.first.camera_from_body.*of, at.middle.camera_from_body.*of,
                       at.last.camera_from_body.*of);
    };
    const auto x = row(&Mat3d::x), y = row(&Mat3d::y), z = row(&Mat3d::z);
    const Vec2d center = center_of_padded(g);
    return {{{{x[0], y[0], z[0]}, {x[1], y[1], z[1]}, {x[2], y[2], z[2]}}},
            through(at.first.origin_m, at.middle.origin_m, at.last.origin_m),
            single(g.focal_length_px),
            single(center.x),
            single(center.y),
            single(depth_origin_m),
            single(g.padded_width()),
            single(g.padded_height())};
}

float rolling_margin_px(const ImageGeometry& g, const LensTiles::Slopes& s, const RowPoses& rows,
                        float speed_px) {
    const double x = std::max(-s.left, s.right), y = std::max(-s.top, s.bottom);
    const double per_rad_px = g.focal_length_px * (1 + x * x + y * y), turn_rad = rows.half_turn_rad();
    const double way_px = static_cast<double>(speed_px) * g.padded_height();
    constexpr double kRounding_px = 0.02, kThird = 0.1, kMixed = 0.3;
    return single(kRounding_px + kThird * per_rad_px * turn_rad * turn_rad * turn_rad +
                  kMixed * way_px * turn_rad * turn_rad);
}

}  // namespace hilcam
