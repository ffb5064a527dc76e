#pragma once
// The loops of the visibility buffer (visibility_buffer.h) over vertices and triangles; visibility_tile.h has
// those over samples. They are compiled for several vector widths, of which the processor's widest runs; all
// give the same results, bit by bit. Loop, any thread.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "render/visibility/visibility_samples.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

inline constexpr std::size_t kTrianglesAtOnce = 16;

// Projects vertices of one object to the screen: x = offset_x + focal (p.x + lean_x p.z + start_x) / z with p
// = axes * vertex and z = p.z + distance; y in the same way. Depth is (depth_origin - z) / z: it is linear on
// the screen, and greater is nearer.
struct ScreenProjection {
    Mat3f axes;                             // camera from body
    float distance = 0, beyond_origin = 0;  // distance of the body's origin [m]; the same minus depth_origin
    float focal_px = 0;
    float offset_x = 0, offset_y = 0, lean_x = 0, lean_y = 0, start_x = 0, start_y = 0;
};

// A vertex on the screen [padded px]. x is NaN if the vertex is not in front of the camera or is far outside
// the picture. speed: motion from one row to the next if rows have different instants [px]; otherwise 0.
struct alignas(16) ScreenVertex {
    float x, y, depth, speed;
};
void project_vertices(std::span<const Vec3f> vertices_m, const ScreenProjection& projection,
                      ScreenVertex* out);

// A lens after project_vertices(), which gives ideal places (lens_tiles.h): Brown's distortion about a
// centre, and the region in which it is valid.
struct ScreenLens {
    float center_x, center_y, focal_px;
    float k1, k2, k3, p1, p2;
    float min_x, max_x, min_y, max_y;  // ideal places of the picture
    float bend_per_px;                 // an edge in a box of n px deviates from its chord by this times n^2
    float tile_error_px;               // error of a tile's affine map
};
// The same lens in a tile: place in it = 8 px + (xx, xy; yx, yy) (ideal place - middle).
struct TileLens {
    float middle_x, middle_y;
    float xx, xy, yx, yy;
};

// The tiles that may show a triangle: x0 to x1 and y0 to y1.
struct TileRange {
    std::uint32_t triangle;
    std::int16_t x0, x1, y0, y1;  // x1 < 0: a corner is not on the screen, and nothing is known
    float nearest;                // greatest depth of the triangle
};
using TriangleCorners = std::array<std::uint32_t, 3>;
// Finds these ranges for triangles that may cover a sample. first: number of the first triangle; lens: null
// without distortion. Returns how many were written; `ranges` needs room for all triangles.
std::size_t find_tiles(const ScreenVertex* vertices, std::span<const TriangleCorners> triangles,
                       std::uint32_t first, int width_px, int height_px, const ScreenLens* lens,
                       TileRange* ranges);

// Sixteen triangles, set up for a tile. A sample at (x, y) from the tile's corner is inside if the sign bit
// of a x + b y + c, flipped by `flip`, is set for all three edges. Triangles with a common edge have the same
// a, b, c and opposite flips, so no sample is lost or counted twice.
struct alignas(64) TriangleSetup {
    std::array<std::array<float, kTrianglesAtOnce>, 3> a, b, c;
    std::array<std::array<std::uint32_t, kTrianglesAtOnce>, 3> flip;
    std::array<float, kTrianglesAtOnce> depth_x, depth_y, depth, min_depth, max_depth;
    std::array<std::int32_t, kTrianglesAtOnce> x0, x1, y0, y1;  // pixels of the tile; x1 < x0: none
    std::array<std::uint32_t, kTrianglesAtOnce> id;
    std::size_t count = 0;
};
// A mesh with its vertices' places on the screen.
struct ScreenMesh {
    const ScreenVertex* vertices;
    const TriangleCorners* triangles;
    std::uint32_t first_id;  // id of its first triangle
    // For each triangle, the one whose id represents it (coplanar_groups.h); null: each has its own.
    const std::uint32_t* coplanar_groups = nullptr;
};
// numbers: of triangles; entries beyond count must be triangles too. lens: of the tile; null without
// distortion.
void set_up_triangles(const ScreenMesh& mesh, const std::array<std::uint32_t, kTrianglesAtOnce>& numbers,
                      std::size_t count, int tile_x_px, int tile_y_px, const TileLens* lens,
                      TriangleSetup& setup);

}  // namespace hilcam
