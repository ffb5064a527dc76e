#pragma once
// Sums over the texels of a mosaic (mosaic.h) about a pixel, eight texels of a row at a time. Compiled for several widths of
// vectors that give the same results.

#include <array>
#include <cstddef>
#include <cstdint>

namespace hilcam {

// Texels side by side: a cache line.
struct alignas(64) MosaicTexels {
    static constexpr std::size_t kLanes = 8, kLayers = 3;
    using Bytes = std::array<std::uint8_t, kLanes>;
    std::array<Bytes, kLayers> share;  // share that each layer fills; 255: all of the texel
    // By the share of what lies on the ground, how it leans along both sides: signed, 127 is Mosaic::kMostLean.
    std::array<Bytes, 2> lean;
    // The share of the ground that is seen in gaps which run down the rectangle; the others run across it.
    Bytes down;
    // By the share of the ground that is in gaps which run down, and across: how narrow they are, 255 where they are as wide as
    // Mosaic::upper_m.
    std::array<Bytes, 2> gap;
};
static_assert(sizeof(MosaicTexels) == 64);

// Eights of texels with their places in the pixel [px from its corner].
struct MosaicWindow {
    static constexpr std::size_t kMost = 256;
    std::array<const MosaicTexels*, kMost> texels;
    std::array<float, kMost> x, y;  // places of the first of each
    std::size_t count = 0;
    float x_step = 0, y_step = 0;  // from each to the next
    // Sides fall off over the width that a texel has there, so that pixels side by side add up to one: that, inverse.
    float x_fall = 0, y_fall = 0;
    // The way of light along across and down, either way, while it rises as high as what lies on the ground, less that of the line of
    // sight [Mosaic::upper_m].
    float across = 0, down = 0;
};
struct MosaicSums {
    std::array<float, MosaicTexels::kLayers> share{};
    std::array<float, MosaicTexels::kLayers> x{}, y{};  // sums of shares times their places
    std::array<float, 2> lean{};
    float lit = 0;  // sum of the share of the ground that light reaches
};
// layers: the first ones, which are asked for. Loop, any thread.
MosaicSums sums_of(const MosaicWindow& window, std::size_t layers);

}  // namespace hilcam
