#include "render/shading/tile.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

Spectrum of(float value) {
    Spectrum out;
    out[0] = value;
    return out;
}

// A lobe whose rays serve two pixels: each has its share, where in the pixel its own samples are.
TEST(Tile, LightThatIsSharedFallsWhereEachOfThemIs) {
    const FrameContext frame;
    std::array<Spectrum, 4> pixels{};
    std::array<float, 12> moments{};
    const std::array<Spectrum, 1> responses{of(10)};
    TileStats stats;
    NormalClusters clusters;
    Tile tile{frame, {0, 0, 2, 2}, 1, pixels, stats, clusters};
    tile.moments = moments, tile.moment_responses = responses;
    const std::array<PixelShare, 2> parts{PixelShare{1, {1, 0, 0}, of(1)}, {2, {0, -1, 0}, of(0.25f)}};
    ShadingPoint at{};
    at.pixel = 3;
    at.moments = {1, 1, 1};
    tile.add(at, LightPart::kSun, of(2));
    GlossyLobe lobe;
    lobe.pixels = parts;
    at.lobe = &lobe;
    tile.add(at, LightPart::kSun, of(4));
    EXPECT_EQ(pixels[1][0], 0) << "until all rays have come back";
    tile.add(lobe, lobe.believed());
    EXPECT_EQ(pixels[0][0], 0);
    EXPECT_EQ(pixels[1][0], 4);
    EXPECT_EQ(pixels[2][0], 1);
    EXPECT_EQ(pixels[3][0], 2);
    // By difference, then by pixel.
    const std::array<float, 12> expected{0, 40, 0, 20, 0, 0, -10, 20, 0, 0, 0, 20};
    EXPECT_EQ(moments, expected);
}

}  // namespace
}  // namespace hilcam
