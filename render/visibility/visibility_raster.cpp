#include "render/visibility/visibility_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/visibility/visibility_raster.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "render/visibility/sixteen_lanes-inl.h"
#include "render/visibility/triangle_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hilcam {
namespace HWY_NAMESPACE {

void project(std::span<const Vec3f> vertices_m, const ScreenProjection& p, ScreenVertex* out) {
    for_vertices(vertices_m, out, [&](V x, V y, V z, float* to) {
        write_vertices(projected(p, x, y, z), hn::Zero(Floats()), to);
    });
}

std::size_t tiles(const ScreenVertex* vertices, std::span<const TriangleCorners> triangles,
                  std::uint32_t first, int width_px, int height_px, const ScreenLens* lens,
                  TileRange* ranges) {
    return lens
               ? tiles_with<true>(vertices, triangles, first, width_px, height_px, lens, NoMargin{}, ranges)
               : tiles_with<false>(vertices, triangles, first, width_px, height_px, lens, NoMargin{}, ranges);
}

void set_up(const ScreenMesh& mesh, const std::array<std::uint32_t, kTrianglesAtOnce>& numbers,
            std::size_t count, int tile_x_px, int tile_y_px, const TileLens* lens, TriangleSetup& s) {
    s.count = count;
    for (std::size_t k = 0; k < count; k += hn::Lanes(Floats())) {
        Corners c = corners_of(mesh.vertices, mesh.triangles, [&](std::size_t i) { return numbers[k + i]; });
        move_into_tile(tile_x_px, tile_y_px, lens, c);
        set_up_lanes(mesh, numbers.data(), c, OneInstant{}, k, s);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace hilcam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hilcam {

HWY_EXPORT(project);
HWY_EXPORT(tiles);
HWY_EXPORT(set_up);

void project_vertices(std::span<const Vec3f> vertices_m, const ScreenProjection& projection,
                      ScreenVertex* out) {
    HWY_DYNAMIC_DISPATCH(project)(vertices_m, projection, out);
}
std::size_t find_tiles(const ScreenVertex* vertices, std::span<const TriangleCorners> triangles,
                       std::uint32_t first, int width_px, int height_px, const ScreenLens* lens,
                       TileRange* ranges) {
    if (triangles.empty()) return 0;
    return HWY_DYNAMIC_DISPATCH(tiles)(vertices, triangles, first, width_px, height_px, lens, ranges);
}
void set_up_triangles(const ScreenMesh& mesh, const std::array<std::uint32_t, kTrianglesAtOnce>& numbers,
                      std::size_t count, int tile_x_px, int tile_y_px, const TileLens* lens,
                      TriangleSetup& setup) {
    HWY_DYNAMIC_DISPATCH(set_up)(mesh, numbers, count, tile_x_px, tile_y_px, lens, setup);
}

}  // namespace hilcam
#endif
