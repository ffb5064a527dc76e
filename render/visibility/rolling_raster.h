#pragma once
// The loops of visibility_raster.h for a camera whose rows have different instants (row_poses.h): where
// vertices appear, which tiles may show triangles, and the set-up of triangles for a tile. Compiled for
// several vector widths, which give the same results, bit by bit. Loop, any thread.
//
// A vertex appears in the row y that satisfies y = (its place at the instant of y). Within a tile, a
// triangle's corners are projected twice, at the instants of the tile's upper and lower edge, and edges and
// depth change linearly in between: an edge function is e(x, y) + (y - y_middle) de/dy, both taken in the
// tile's middle. Triangles with a common edge use the same numbers. Neglected: variations of that change
// within the tile, 0.001 px for a camera that turns by 30 deg/s with rows of 40 us; and that a row of pixels
// is one instant: at its upper and lower border places are off by half of the motion per row, and not on
// average.

#include "render/visibility/visibility_raster.h"

namespace hilcam {

// Projects vertices of one object to the screen. Camera from body is axes[0] + u axes[1] + u^2 axes[2], and
// the body's origin is given in the same way; u is -1 at the picture's upper edge and 1 at its lower one.
struct RollingProjection {
    std::array<Mat3f, 3> axes;
    std::array<Vec3f, 3> origin_m;
    float focal_px = 0, center_x = 0, center_y = 0;
    float depth_origin_m = 1;  // see ScreenProjection: depth is (depth_origin - z) / z
    float width_px = 0, height_px = 0;
};
// Writes where vertices appear, as ideal places (lens_tiles.h); depth is the greatest in the frame. lens:
// null without distortion. Returns the largest motion of a visible vertex from one row to the next [px].
float roll_vertices(std::span<const Vec3f> vertices_m, const RollingProjection& projection,
                    const ScreenLens* lens, ScreenVertex* out);

// Like find_tiles(), for these vertices. margin_px: the largest error of their places.
std::size_t find_rolling_tiles(const ScreenVertex* vertices, std::span<const TriangleCorners> triangles,
                               std::uint32_t first, int width_px, int height_px, float margin_px,
                               const ScreenLens* lens, TileRange* ranges);

// A mesh at the instants of a tile's upper and lower edge. Its vertices on the screen are not used.
struct RollingMesh {
    ScreenMesh mesh;
    const Vec3f* vertices_m;
    ScreenProjection upper, lower;
};
void set_up_rolling_triangles(const RollingMesh& mesh,
                              const std::array<std::uint32_t, kTrianglesAtOnce>& numbers, std::size_t count,
                              int tile_x_px, int tile_y_px, const TileLens* lens, TriangleSetup& setup);

}  // namespace hilcam
