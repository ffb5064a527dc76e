#pragma once
// A tile of the visibility buffer: the triangle that each of its samples sees, and its depth. Its loops are
// compiled for several vector widths, which give the same results, bit by bit. Loop, any thread.

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
    // The least depth in each pixel and each quarter at the last find_farthest(): whatever is behind that is
    // hidden. Padded, because squares of 4 x 4 pixels may extend beyond the tile.
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

// The ids that the samples of a pixel of the picture see, each once, in falling order of the number of
// samples; for equal numbers, the smaller mask first.
struct PixelFragments {
    struct Fragment {
        std::uint32_t id;
        std::uint32_t others;  // samples that see something else
        SampleMask samples;    // one bit each, as in PixelSamples
    };
    std::array<Fragment, kMaxVisibilitySamples> fragments;
    std::size_t count = 0;
    SampleMask nothing = 0;  // samples that see nothing, one bit each
};
// ids: of the pixel's upper left buffer pixel (VisibilityTile::ids()). across: width and height of the pixel
// in buffer pixels, 1 or 2.
void list_fragments(const std::uint32_t* ids, int across, PixelFragments& out);

}  // namespace hilcam
