#pragma once
// Normals of ground that is finer than its triangles: a grid of them on each square tile of 32 x 32 quadrilaterals, kTexels on an
// edge of a quadrilateral, and another half as fine, between which the tile's vertices choose.
//
// A tile's triangles come two by two, row by row: of the quadrilateral at (x, y) first that of its corners (0, 0), (1, 0), (0, 1), then
// (1, 0), (1, 1), (0, 1). What comes after them in a tile, and after the last tile, has no such normals.

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "render/scene/packed_normal.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// A triangle's sunlight is known in one of these ways before a ray asks.
enum class SunVisibility : std::uint8_t { kAsk, kLit, kDark };

class GroundNormals {
  public:
    static constexpr int kQuads = 32, kTexels = 4;
    static constexpr int kSide = kQuads * kTexels + 1, kHalfSide = kQuads * kTexels / 2 + 1;
    using Grid = std::vector<std::uint32_t>;  // packed normals, by row

    struct Tile {
        std::shared_ptr<const Grid> own, above;                       // kSide x kSide, kHalfSide x kHalfSide
        std::array<std::uint8_t, (kQuads + 1) * (kQuads + 1)> share;  // at a vertex, of the second: 0 to 255
    };
    std::vector<Tile> tiles;
    std::uint32_t triangles_per_tile = 1;

    bool has(std::uint32_t triangle) const {
        return triangle / triangles_per_tile < tiles.size() &&
               triangle % triangles_per_tile < 2 * kQuads * kQuads;
    }

    // Finds the normal at barycentric (u, v) of a triangle, unit; false where there is none. Loop, any thread.
    bool find(std::uint32_t triangle, float u, float v, Vec3f& normal) const {
        if (!has(triangle)) return false;
        const std::uint32_t in_tile = triangle % triangles_per_tile;
        const Tile& tile = tiles[triangle / triangles_per_tile];
        const std::uint32_t x = in_tile / 2 % kQuads, y = in_tile / 2 / kQuads;
        const bool second = in_tile % 2 == 1;
        const float dx = second ? 1 - v : u, dy = second ? u + v : v;
        const std::uint8_t* const share = &tile.share[y * (kQuads + 1) + x];
        const float low = (1 - dx) * share[0] + dx * share[1],
                    high = (1 - dx) * share[kQuads + 1] + dx * share[kQuads + 2];
        const float above = ((1 - dy) * low + dy * high) * (1.0f / 255);
        const float px = (static_cast<float>(x) + dx) * kTexels, py = (static_cast<float>(y) + dy) * kTexels;
        Vec3f sum{};
        if (above < 1) sum = sum + (1 - above) * bilinear(*tile.own, kSide, px, py);
        if (above > 0) sum = sum + above * bilinear(*tile.above, kHalfSide, 0.5f * px, 0.5f * py);
        normal = normalized(sum);
        return true;
    }

  private:
    static Vec3f bilinear(const Grid& grid, int side, float x, float y) {
        const int i = std::min(static_cast<int>(x), side - 2), j = std::min(static_cast<int>(y), side - 2);
        const float dx = x - static_cast<float>(i), dy = y - static_cast<float>(j);
        const std::uint32_t* const at = grid.data() + j * side + i;
        return (1 - dy) * ((1 - dx) * unpack_long_normal(at[0]) + dx * unpack_long_normal(at[1])) +
               dy * ((1 - dx) * unpack_long_normal(at[side]) + dx * unpack_long_normal(at[side + 1]));
    }
};

}  // namespace hilcam
