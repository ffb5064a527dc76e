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

TEST(Tile, LightFallsWhereItsSamplesAre) {
    const FrameContext frame;
    std::array<Spectrum, 4> pixels{};
    std::array<float, 12> moments{};
    const std::array<Spectrum, 1> responses{of(10)};
    TileStats stats;
    NormalClusters clusters;
    Tile tile{frame, {0, 0, 2, 2}, 1, pixels, stats, clusters};
    tile.moments = moments, tile.moment_responses = responses;
    ShadingPoint at{};
    at.pixel = 3;
    at.moments = {1, -1, 0.5f};
    tile.add(at, LightPart::kSun, of(2));
    EXPECT_EQ(pixels[3][0], 2);
    // By difference, then by pixel.
    const std::array<float, 12> expected{0, 0, 0, 20, 0, 0, 0, -20, 0, 0, 0, 10};
    EXPECT_EQ(moments, expected);
}

// Light that a lobe's ray meets is kept with the ray, until all have come back.
TEST(Tile, LightThatARayHasMetIsTheRays) {
    const FrameContext frame;
    std::array<Spectrum, 4> pixels{};
    TileStats stats;
    NormalClusters clusters;
    Tile tile{frame, {0, 0, 2, 2}, 1, pixels, stats, clusters};
    GlossyRay ray;
    ray.light = of(1);
    ShadingPoint at{};
    at.glossy_ray = &ray;
    tile.add(at, LightPart::kSun, of(4));
    EXPECT_EQ(ray.light[0], 5);
    for (const Spectrum& pixel : pixels) EXPECT_EQ(pixel[0], 0);
}

}  // namespace
}  // namespace hilcam
