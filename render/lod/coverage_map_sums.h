#pragma once
// Sums over the texels of a coverage map (coverage_map.h) about a pixel, twice eight texels of a row at a time. Compiled for
// several widths of vectors that give the same results.

#include <array>
#include <cstddef>
#include <cstdint>

namespace hilcam {

// Texels side by side: a cache line.
struct alignas(64) CoverageTexels {
    static constexpr std::size_t kLanes = 8, kLayers = 3;
    using Bytes = std::array<std::uint8_t, kLanes>;
    std::array<Bytes, kLayers> share;  // share that each layer fills; 255: all of the texel
    // By the share of what lies on the ground, how it leans along both sides: signed, 127 is CoverageMap::kMaxLean.
    std::array<Bytes, 2> lean;
    // The share of the ground that is seen in gaps which run down the rectangle; the others run across it.
    Bytes down;
    // By the share of the ground that is in gaps which run down, and across: how narrow they are, 255 where they are as wide as
    // CoverageMap::upper_m.
    std::array<Bytes, 2> gap;

    bool operator==(const CoverageTexels&) const = default;
};
static_assert(sizeof(CoverageTexels) == 64);

// Eights of texels about a pixel, and how these lie in it. Lengths in it are widths that a texel takes along its sides there: a
// side falls off over one, so that pixels side by side add up to one.
struct CoverageWindow {
    static constexpr std::size_t kMax = 256;
    const CoverageTexels* kinds = nullptr;
    const std::uint32_t* eights = nullptr;  // the kind of each, from the window's first one on
    std::uint32_t row_of_eights = 0;        // from one row to the next
    std::uint32_t rows = 0, across = 0;     // number of rows, and of eights in each
    float column = 0, row = 0;              // the first texel, from the pixel's middle [texels]
    // The way in the pixel from a texel to the next in its row and in its column.
    float x_column = 0, x_row = 0, y_column = 0, y_row = 0;
    // A texel is just not in the pixel as far from its middle as this, and wholly if a width nearer.
    float x_reach = 0, y_reach = 0;
    // The way of light along the coverage map's sides, either way, while it rises as high as what lies on the ground, less that
    // of the line of sight [CoverageMap::upper_m].
    float light_across = 0, light_down = 0;
};
struct CoverageSums {
    std::array<float, CoverageTexels::kLayers> share{};
    std::array<float, CoverageTexels::kLayers> x{},
        y{};  // sums of shares times their places, from the middle
    std::array<float, 2> lean{};
    float lit = 0;  // sum of the share of the ground that light reaches
};
// False: the pixel has parts of more than kMax eights. Loop, any thread.
bool find_sums(const CoverageWindow& window, CoverageSums& out);

}  // namespace hilcam
