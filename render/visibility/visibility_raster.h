#pragma once
// The loops of the visibility buffer (visibility_buffer.h) that touch every vertex and triangle; visibility_tile.h has
// those that touch every sample. They are compiled for several widths of vectors, and the widest that the processor has
// runs; all of them give the same results, bit by bit. Loop, any thread.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "render/visibility/visibility_samples.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

inline constexpr std::size_t kTrianglesAtOnce = 16;

// Takes vertices of one object to the screen. x = offset_x + focal (p.x + lean_x p.z + start_x) / z with p =
// axes * vertex and z = p.z + distance; y alike. Depth is (depth_origin - z) / z: linear on the screen,
// greater is nearer.
struct ScreenProjection {
    Mat3f axes;                             // camera from body
    float distance = 0, beyond_origin = 0;  // distance of the body's origin [m]; that less depth_origin
    float focal_px = 0;
    float offset_x = 0, offset_y = 0, lean_x = 0, lean_y = 0, start_x = 0, start_y = 0;
};

// A vertex on the screen [padded px]. x is NaN where a vertex is not before the camera, or far beside the
// picture. speed: how far it moves from one row to the next, where rows are of several instants [px]; else 0.
struct alignas(16) ScreenVertex {
    float x, y, depth, speed;
};
void project_vertices(std::span<const Vec3f> vertices_m, const ScreenProjection& projection,
                      ScreenVertex* out);

// A lens after project_vertices(), which gives ideal places (lens_tiles.h): Brown's distortion about a
// centre, and how far it may be trusted.
struct ScreenLens {
    float center_x, center_y, focal_px;
    float k1, k2, k3, p1, p2;
    float min_x, max_x, min_y, max_y;  // ideal places of the picture
    float bend_per_px;    // an edge in a box of so many px leaves its chord by that times its square
    float tile_error_px;  // error of a tile's own map
};
// The same lens in a tile: place on it = 8 px + (xx, xy; yx, yy) (ideal place - middle).
struct TileLens {
    float middle_x, middle_y;
    float xx, xy, yx, yy;
};

// Tiles that a triangle may be seen in, from x0 to x1 and y0 to y1.
struct TileRange {
    std::uint32_t triangle;
    std::int16_t x0, x1, y0, y1;  // x1 < 0: a corner is not on the screen, nothing is known
    float nearest;                // its greatest depth
};
using TriangleCorners = std::array<std::uint32_t, 3>;
// Those that triangles cover a sample of, at most. first: number of the first triangle; lens: null without.
// Returns how many were written; ranges holds as many as there are triangles.
std::size_t find_tiles(const ScreenVertex* vertices, std::span<const TriangleCorners> triangles,
                       std::uint32_t first, int width_px, int height_px, const ScreenLens* lens,
                       TileRange* ranges);

// Sixteen triangles ready for a tile. A sample at (x, y) from the tile's corner is inside where the sign bit
// of a x + b y + c, flipped by `flip`, is set for all three edges. Two triangles that share an edge have the
// same a, b, c and opposite flips: no sample is lost or met twice.
struct alignas(64) TriangleSetup {
    std::array<std::array<float, kTrianglesAtOnce>, 3> a, b, c;
    std::array<std::array<std::uint32_t, kTrianglesAtOnce>, 3> flip;
    std::array<float, kTrianglesAtOnce> depth_x, depth_y, depth, min_depth, max_depth;
    std::array<std::int32_t, kTrianglesAtOnce> x0, x1, y0, y1;  // pixels of the tile; x1 < x0: none
    std::array<std::uint32_t, kTrianglesAtOnce> id;
    std::size_t count = 0;
};
// A mesh and where its vertices are on the screen.
struct ScreenMesh {
    const ScreenVertex* vertices;
    const TriangleCorners* triangles;
    std::uint32_t first_id;  // id of its first triangle
    // They say for each triangle whose id stands for it (coplanar_groups.h); null: each has its own.
    const std::uint32_t* coplanar_groups = nullptr;
};
// numbers: of triangles; what is beyond count must be a triangle, too. lens: of the tile; null without.
void set_up_triangles(const ScreenMesh& mesh, const std::array<std::uint32_t, kTrianglesAtOnce>& numbers,
                      std::size_t count, int tile_x_px, int tile_y_px, const TileLens* lens,
                      TriangleSetup& setup);

}  // namespace hilcam
