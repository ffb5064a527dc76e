#include "render/visibility/cut_triangles.h"

#include <algorithm>
#include <cmath>

namespace hilcam {

bool bounds_of_cut(const CornersInCamera& corners_m, const ImageGeometry& geometry, const LensTiles& lens,
                   TileRange& range) {
    const LensTiles::Slopes& slopes = lens.slopes();
    const auto all = [&](auto&& says) { return std::all_of(corners_m.begin(), corners_m.end(), says); };
    if (all([](Vec3d p) { return p.z <= 0; }) || all([&](Vec3d p) { return p.x < slopes.left * p.z; }) ||
        all([&](Vec3d p) { return p.x > slopes.right * p.z; }) ||
        all([&](Vec3d p) { return p.y < slopes.top * p.z; }) ||
        all([&](Vec3d p) { return p.y > slopes.bottom * p.z; }))
        return false;
    double x0 = 1e300, x1 = -1e300, y0 = 1e300, y1 = -1e300;
    const Vec2d center{geometry.center_px().x + geometry.guard_px,
                       geometry.center_px().y + geometry.guard_px};
    const auto grow = [&](Vec3d p) {
        const double x = center.x + p.x / p.z * geometry.focal_length_px;
        const double y = center.y + p.y / p.z * geometry.focal_length_px;
        x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
    };
    double reach = 0;
    for (const Vec3d& p : corners_m) reach = std::max(reach, length(p));
    const double near_m = 1e-9 * reach;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d& p = corners_m[i];
        const Vec3d& q = corners_m[(i + 1) % 3];
        if (p.z >= near_m) grow(p);
        if ((p.z < near_m) == (q.z < near_m)) continue;
        Vec3d at = p + (near_m - p.z) / (q.z - p.z) * (q - p);
        at.z = near_m;
        grow(at);
    }
    lens.tiles_of(x0, x1, y0, y1, range);
    return true;
}

namespace {

// A linear function of the place in a tile, a x + b y + c, and its value in the tile's middle.
Vec3d on_tile(Vec3d plane, const LensTiles::View& view) {
    return {dot(plane, view.right), dot(plane, view.down), dot(plane, view.corner)};
}
double in_middle(Vec3d function) { return 0.5 * kVisibilityTile_px * (function.x + function.y) + function.z; }

// The planes of a triangle's edges, divided by a volume. With the volume of triangle and camera they give the
// barycentric coordinates, times a ray's depth.
std::array<Vec3d, 3> edges_of(const CornersInCamera& p, double volume) {
    return {cross(p[1], p[2]) / volume, cross(p[2], p[0]) / volume, cross(p[0], p[1]) / volume};
}
Vec3d sum_of(const std::array<Vec3d, 3>& edges) { return Vec3d{} + edges[0] + edges[1] + edges[2]; }
double volume_of(const CornersInCamera& p) { return dot(p[0], cross(p[1], p[2])); }

// Returns the function at the middle's instant, changing from row to row like its value in the tile's middle.
// With one instant both are exactly the function.
Vec3d between(Vec3d upper, Vec3d lower) {
    const double per_row = (in_middle(lower) - in_middle(upper)) / kVisibilityTile_px;
    Vec3d out = 0.5 * (upper + lower);
    out.y += per_row, out.z -= 0.5 * kVisibilityTile_px * per_row;
    return out;
}

}  // namespace

void set_up_cut(const CutTriangle& triangle, const LensTiles::View& view, TriangleSetup& setup) {
    const double upper_volume = volume_of(triangle.upper_m), lower_volume = volume_of(triangle.lower_m);
    // Seen edge-on, or turned over within the tile: not visible.
    const bool flat = !(upper_volume * lower_volume > 0);
    setup.count = 1;
    setup.x0[0] = setup.y0[0] = 0;
    setup.y1[0] = kVisibilityTile_px - 1;
    setup.x1[0] = flat ? -1 : kVisibilityTile_px - 1;
    setup.min_depth[0] = -1, setup.max_depth[0] = 1e30f;
    setup.id[0] = triangle.id;
    if (flat) return;
    // Triangles with a common edge have its planes in the same ratio at both instants, so each uses one
    // volume for both.
    const double volume = 0.5 * (upper_volume + lower_volume);
    const std::array<Vec3d, 3> upper = edges_of(triangle.upper_m, volume),
                               lower = edges_of(triangle.lower_m, volume);
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d plane = between(on_tile(upper[i], view), on_tile(lower[i], view));
        const double greatest = std::max({std::abs(plane.x), std::abs(plane.y), std::abs(plane.z), 1e-300});
        setup.a[i][0] = static_cast<float>(plane.x / greatest);
        setup.b[i][0] = static_cast<float>(plane.y / greatest);
        setup.c[i][0] = static_cast<float>(plane.z / greatest) + 0.0f;
        setup.flip[i][0] = 0x80000000u;
    }
    const Vec3d sum = between(on_tile(sum_of(edges_of(triangle.upper_m, upper_volume)), view),
                              on_tile(sum_of(edges_of(triangle.lower_m, lower_volume)), view));
    setup.depth_x[0] = static_cast<float>(triangle.depth_origin_m * sum.x);
    setup.depth_y[0] = static_cast<float>(triangle.depth_origin_m * sum.y);
    setup.depth[0] = static_cast<float>(triangle.depth_origin_m * sum.z - 1);
}

}  // namespace hilcam
