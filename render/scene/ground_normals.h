#pragma once
// Normals of ground at a finer resolution than its triangles. Each square tile has 32 x 32 quadrilaterals and
// a grid of normals with kTexels along an edge of a quadrilateral, and a second grid with half that
// resolution. Weights at the tile's vertices blend the two.
//
// A tile's triangles come in pairs, row by row: for the quadrilateral at (x, y) first the triangle of the
// corners (0, 0), (1, 0), (0, 1), then (1, 0), (1, 1), (0, 1). Later triangles of a tile, and those after the
// last tile, have no such normals.

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "render/scene/packed_normal.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// A triangle's sunlight as known in advance: a ray has to ask, it is lit, or it is dark.
enum class SunVisibility : std::uint8_t { kAsk, kLit, kDark };

class GroundNormals {
  public:
    static constexpr int kQuads = 32, kTexels = 4;
    static constexpr int kSide = kQuads * kTexels + 1, kHalfSide = kQuads * kTexels / 2 + 1;
    using Grid = std::vector<std::uint32_t>;  // packed normals, by row

    struct Tile {
        std::shared_ptr<const Grid> own, above;  // kSide x kSide, kHalfSide x kHalfSide
        // Weight of `above` at each vertex, 0 to 255.
        std::array<std::uint8_t, (kQuads + 1) * (kQuads + 1)> share;
    };
    std::vector<Tile> tiles;
    std::uint32_t triangles_per_tile = 1;

    bool has(std::uint32_t triangle) const {
        return triangle / triangles_per_tile < tiles.size() &&
               triangle % triangles_per_tile < 2 * kQuads * kQuads;
    }

    // Finds the unit normal at barycentric (u, v) of a triangle; returns false if it has no such normals.
    // Loop, any thread.
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
