#pragma once
// The loops of visibility_raster.h for a camera whose rows are of several instants (row_poses.h): where vertices appear, which tiles
// may see triangles, and what makes triangles ready for a tile. Compiled for several widths of vectors that give the same results, bit
// by bit. Loop, any thread.
//
// A vertex appears in the row that sees it there: y = (its place at the instant of y). In a tile a triangle's corners are projected
// twice, at the instants of the tile's upper and lower edge, and its edges and its depth change evenly in between: an edge's function
// is e(x, y) + (y - y_middle) de/dy, both of them as in the tile's middle. Two triangles that share an edge take the same numbers.
// What is left out is how that change differs within the tile, 0.001 px for a camera that turns by 30 deg/s with rows of 40 us, and
// that a row of pixels is one instant: places at its upper and lower border are half of what moves in a row beside it, and in the
// mean not.

#include "render/visibility/visibility_raster.h"

namespace hilcam {

// Takes vertices of one object to the screen: camera from body is axes[0] + u axes[1] + u^2 axes[2], and alike the place of the body's
// origin; u is -1 at the picture's upper edge, and 1 at its lower one.
struct RollingProjection {
    std::array<Mat3f, 3> axes;
    std::array<Vec3f, 3> origin_m;
    float focal_px = 0, center_x = 0, center_y = 0;
    float depth_origin_m = 1;  // ScreenProjection: depth is (depth_origin - z) / z
    float width_px = 0, height_px = 0;
};
// Writes where vertices appear, as a pinhole shows the place from which the lens bends them; depth is the greatest in the frame. lens:
// null without. Returns how far a vertex that is in the picture moves from one row to the next, at most [px].
float roll_vertices(std::span<const Vec3f> vertices_m, const RollingProjection& projection,
                    const ScreenLens* lens, ScreenVertex* out);

// find_tiles() for these vertices. margin_px: how far they may be beside their places.
std::size_t find_rolling_tiles(const ScreenVertex* vertices, std::span<const TriangleCorners> triangles,
                               std::uint32_t first, int width_px, int height_px, float margin_px,
                               const ScreenLens* lens, TileRange* ranges);

// A mesh at the instants of a tile's upper and lower edge. The vertices on the screen are not looked at.
struct RollingMesh {
    ScreenMesh mesh;
    const Vec3f* vertices_m;
    ScreenProjection upper, lower;
};
void set_up_rolling_triangles(const RollingMesh& mesh,
                              const std::array<std::uint32_t, kTrianglesAtOnce>& numbers, std::size_t count,
                              int tile_x_px, int tile_y_px, const TileLens* lens, TriangleSetup& setup);

}  // namespace hilcam
