#pragma once
// A tile of the visibility buffer: which triangle each of its samples sees, and how near it is. Its loops are compiled for
// several widths of vectors that give the same results, bit by bit. Loop, any thread.

#include <array>
#include <cstddef>
#include <cstdint>

#include "render/visibility/visibility_samples.h"

namespace hilcam {

struct TriangleSetup;  // visibility_raster.h

// The nearest triangle that each sample of a tile sees.
struct alignas(64) VisibilityTile {
    static constexpr std::uint32_t kNothing = ~std::uint32_t{0};
    static constexpr std::size_t kSize =
        std::size_t{kVisibilityTile_px} * kVisibilityTile_px * kVisibilitySamples;
    static constexpr float kBehindAll = -2;
    std::array<float, kSize> depth;
    std::array<std::uint32_t, kSize> id;
    // The least depth in each pixel, and in each quarter, when find_farthest() looked last: what is behind that is hidden.
    // Squares of 4 x 4 pixels may reach beyond.
    static constexpr std::size_t kPixels = std::size_t{kVisibilityTile_px} * kVisibilityTile_px;
    std::array<float, kPixels + 4 * kVisibilityTile_px> farthest_of;
    std::array<float, 4> farthest;

    void clear() {
        depth.fill(kBehindAll);
        id.fill(kNothing);
        farthest_of.fill(kBehindAll);
        farthest.fill(kBehindAll);
    }
    const std::uint32_t* ids(int x, int y) const {
        return &id[static_cast<std::size_t>((y * kVisibilityTile_px + x) * kVisibilitySamples)];
    }
};
void fill_tile(const TriangleSetup& setup, VisibilityTile& tile);
void find_farthest(VisibilityTile& tile);

// This is what the samples of a pixel of the picture see: each id once, first the one that most of them see; of two with
// as many the one whose mask is less.
struct PixelFragments {
    struct Fragment {
        std::uint32_t id;
        std::uint32_t others;  // number of samples that see something else
        SampleMask samples;    // a bit each, as PixelSamples has them
    };
    std::array<Fragment, kMaxVisibilitySamples> fragments;
    std::size_t count = 0;
    SampleMask nothing = 0;  // samples that see nothing, a bit each
};
// ids: of its upper left pixel in the tile (VisibilityTile::ids()). across: how many of the tile's pixels it is wide and
// high, 1 or 2.
void list_fragments(const std::uint32_t* ids, int across, PixelFragments& out);

}  // namespace hilcam
