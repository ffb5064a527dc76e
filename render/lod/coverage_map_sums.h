#pragma once
// Sums the texels of a coverage map (coverage_map.h) around a pixel, twice eight texels of a row at a time.
// Compiled for several vector widths, which give the same results.

#include <array>
#include <cstddef>
#include <cstdint>

namespace hilcam {

// Eight texels side by side: a cache line.
struct alignas(64) CoverageTexels {
    static constexpr std::size_t kLanes = 8, kLayers = 3;
    using Bytes = std::array<std::uint8_t, kLanes>;
    std::array<Bytes, kLayers> share;  // share that each layer fills; 255: the whole texel
    // The lean of what is on the ground along both sides, times its share: signed, 127 is
    // CoverageMap::kMaxLean.
    std::array<Bytes, 2> lean;
    // The share of the visible ground in gaps that run down the rectangle; the others run across it.
    Bytes down;
    // The narrowness of gaps that run down, and across, times the share of the ground in them: 255 if they
    // are as wide as CoverageMap::upper_m.
    std::array<Bytes, 2> gap;

    bool operator==(const CoverageTexels&) const = default;
};
static_assert(sizeof(CoverageTexels) == 64);

// The groups of eight texels around a pixel, and where they are in it. The unit of length along each side is
// the width of a texel's footprint there; the filter falls off over one unit, so that neighbouring pixels add
// up to one.
struct CoverageWindow {
    static constexpr std::size_t kMax = 256;
    const CoverageTexels* kinds = nullptr;
    const std::uint32_t* eights = nullptr;  // kind of each group, from the window's first one on
    std::uint32_t row_of_eights = 0;        // from one row to the next
    std::uint32_t rows = 0, across = 0;     // number of rows, and of groups in each
    float column = 0, row = 0;              // first texel, relative to the pixel's middle [texels]
    // The steps in the pixel from a texel to the next one in its row and in its column.
    float x_column = 0, x_row = 0, y_column = 0, y_row = 0;
    // A texel with its middle at this distance is just outside the pixel; one unit nearer, it is wholly
    // inside.
    float x_reach = 0, y_reach = 0;
    // The movement of light along the map's sides, in either direction, while it rises to the height of what
    // is on the ground, minus the same for the line of sight [CoverageMap::upper_m].
    float light_across = 0, light_down = 0;
};
struct CoverageSums {
    std::array<float, CoverageTexels::kLayers> share{};
    std::array<float, CoverageTexels::kLayers> x{},
        y{};  // sums of shares times their places, from the middle
    std::array<float, 2> lean{};
    float lit = 0;  // sum of the ground's lit share
};
// Returns false if the pixel has parts of more than kMax groups. Loop, any thread.
bool find_sums(const CoverageWindow& window, CoverageSums& out);

}  // namespace hilcam
