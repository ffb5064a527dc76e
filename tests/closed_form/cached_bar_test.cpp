// Light of a bar that few directions meet, kept (irradiance_cache.h), against random paths.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "tests/support/corner.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

constexpr double kSeen_m = 0.8;  // to either side of the middle, by the next stage's camera

// A camera four metres above things, and all of their light.
Stage stage_above(const char* model, int depth, int samples, int size_px) {
    Stage s;
    s.quality.path_model = model;
    s.quality.max_depth = depth;
    s.quality.contribution_threshold = 0;
    s.quality.facets_behind_diffuse = 0;
    s.quality.samples_per_axis = samples;
    s.quality.rays_across = 0;
    s.camera(size_px, kSeen_m / 4);
    return s;
}

// A plate of two metres in the shade, above one side of which a thin bar is in the Sun, as a camera of kSize_px above the plate's
// middle has it, in blocks of 6 x 6 px.
struct PlateAndBar {
    static constexpr std::size_t kSize_px = 48, kBlock_px = 6, kAcross = kSize_px / kBlock_px;
    std::vector<double> pixels;
    std::array<double, kAcross * kAcross> blocks{};  // means

    PlateAndBar(const char* model, const MaterialConfig& material, float bar_m, int samples,
                const std::vector<std::uint8_t>& greys = {255}, const char* visibility = "rays") {
        Stage s = stage_above(model, 2, samples, kSize_px);
        s.quality.visibility = visibility;
        const float x0 = 1.2f, x1 = x0 + bar_m;
        SceneObject object = object_of({{-1, -1, 0},
                                        {1, -1, 0},
                                        {1, 1, 0},
                                        {-1, 1, 0},
                                        {x0, -1, 1},
                                        {x1, -1, 1},
                                        {x1, 1, 1},
                                        {x0, 1, 1}},
                                       {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}, material, s.grid);
        s.add(painted(std::move(object), greys), {0, 0, 4});
        s.sun({0.5, 0, 1});
        s.render();
        pixels.assign(s.radiance.plane(0).begin(), s.radiance.plane(0).end());
        for (std::size_t i = 0; i < pixels.size(); ++i)
            blocks[block_of(i)] += pixels[i] / (kBlock_px * kBlock_px);
    }
    double column(std::size_t x) const {
        double sum = 0;
        for (std::size_t i = x; i < pixels.size(); i += kSize_px) sum += pixels[i];
        return sum;
    }
    static std::size_t block_of(std::size_t pixel) {
        return pixel / kSize_px / kBlock_px * kAcross + pixel % kSize_px / kBlock_px;
    }
};

// Metal mirrors the bar: of its places some have a direction that meets the bar, of sixty, and others have none. No part of
// the plate is much brighter than the brightest is by random paths.
TEST(IrradianceCache, ABarThatFewDirectionsMeetIsNoBrighterThanItIs) {
    const auto brightest = [](const char* model, int samples, std::uint8_t grey) {
        MaterialConfig metal = lambert(0.9);
        metal.model = kModel<brdf::Metal>;
        metal.roughness = 0.45;
        const PlateAndBar seen(model, metal, 0.01f, samples, {grey});
        return *std::max_element(seen.blocks.begin(), seen.blocks.end());
    };
    for (const std::uint8_t grey : {std::uint8_t{255}, kGrey}) {
        const double paths = brightest("path", 24, grey);
        EXPECT_GT(paths, 0);
        EXPECT_LT(brightest("cached", 4, grey), 1.5 * paths) << int{grey};
    }
}

// The plate is the same all along the bar, so its light changes along a column of pixels mostly by its error. Rays are added where few
// meet the bar: without those the light changes by 0.139 (rms).
TEST(IrradianceCache, MetalBesideABarHasRaysEnough) {
    MaterialConfig metal = lambert(0.9);
    metal.model = kModel<brdf::Metal>;
    metal.roughness = 0.45;
    const PlateAndBar seen("cached", metal, 0.2f, 4, {255}, "buffer");
    constexpr std::size_t kSize = PlateAndBar::kSize_px, kFirst = kSize / 4, kLast = 3 * kSize / 4;
    double squares = 0, lights = 0;
    for (std::size_t x = 0; x < kSize; ++x) {
        double sum = 0, of_column = 0;
        for (std::size_t y = kFirst; y < kLast; ++y) {
            const double light = seen.pixels[y * kSize + x];
            sum += light, of_column += light * light;
        }
        const double mean = sum / (kLast - kFirst);
        squares += of_column / (kLast - kFirst) - mean * mean, lights += mean * mean;
    }
    EXPECT_GT(lights, 0);
    EXPECT_LT(std::sqrt(squares / lights), 0.11);
}

// Without the Sun nobody can say which error counts: a lobe of the plate then has two rays, not nine, as frames of an eclipse would take
// twice their time.
TEST(IrradianceCache, WithoutTheSunALobeHasTwoRays) {
    Stage s = stage_above("cached", 2, 4, 48);
    s.quality.visibility = "buffer";
    s.models.radiance = "emissive";
    s.scene.sun_irradiance_1au_w_m2_um = {};
    MaterialConfig metal = lambert(0.9), hot = lambert(0);
    metal.model = kModel<brdf::Metal>;
    metal.roughness = 0.45;
    hot.temperature_k = 1000;
    const std::vector<Vec3f> bar{{1.2f, -1, 1}, {1.4f, -1, 1}, {1.4f, 1, 1}, {1.2f, 1, 1}};
    s.add(joined(plate(metal, s.grid), object_of(bar, {{0, 1, 2}, {0, 2, 3}}, hot, s.grid)), {0, 0, 4});
    s.render();
    const auto pixels = static_cast<std::uint64_t>(s.radiance.plane(0).size());
    EXPECT_GT(s.stats.secondary_rays, pixels);
    EXPECT_LE(s.stats.secondary_rays, 2 * pixels);
}

// Stripes on metal, a few pixels wide, beside a bar that few directions meet, so that rays follow lobes, and beside one that
// many meet. Four pixels share what lobes meet, and yet each has its own colour: bright stripes are as much brighter than dark
// ones as on paint.
TEST(IrradianceCache, PixelsOfMetalWithAPictureHaveTheirOwnColours) {
    std::vector<std::uint8_t> stripes;
    for (int i = 0; i < 12; ++i) stripes.insert(stripes.end(), {kGrey, kDarkGrey});
    const auto columns = [&](const MaterialConfig& material, float bar_m) {
        const PlateAndBar plain("cached", material, bar_m, 4, {254}, "buffer"),
            striped("cached", material, bar_m, 4, stripes, "buffer");
        std::vector<double> out;
        for (std::size_t x = 0; x < PlateAndBar::kSize_px; ++x)
            out.push_back(striped.column(x) / plain.column(x));
        return out;
    };
    MaterialConfig metal = lambert(0.9);
    metal.model = kModel<brdf::Metal>;
    metal.roughness = 0.45;
    const std::vector<double> paint = columns(lambert(0.9), 0.6f);
    const double mean = std::accumulate(paint.begin(), paint.end(), 0.0) / static_cast<double>(paint.size());
    const auto contrast = [&](const std::vector<double>& of) {
        double bright = 0, dark = 0;
        for (std::size_t x = 0; x < of.size(); ++x) (paint[x] > mean ? bright : dark) += of[x];
        return bright / dark;
    };
    EXPECT_GT(contrast(paint), 1.5);
    for (const float bar_m : {0.2f, 0.6f})
        EXPECT_NEAR(contrast(columns(metal, bar_m)) / contrast(paint), 1, 0.03) << bar_m;
}

// A round bar of metal along y that lies on paint, lit from above and a little from the left.
SceneObject paint_and_bar(const SpectralGrid& grid) {
    constexpr int kSides = 64;
    constexpr double kBarRadius_m = 0.15;
    std::vector<Vec3f> v;
    std::vector<std::array<std::uint32_t, 3>> t;
    for (int i = 0; i < kSides; ++i)
        for (const double y : {-1.0, 1.0}) {
            const double angle = 2 * kPi * i / kSides;
            v.push_back(
                to_float({kBarRadius_m * std::cos(angle), y, 0.02 + kBarRadius_m * (1 + std::sin(angle))}));
        }
    for (std::uint32_t i = 0; i < 2 * kSides; i += 2) {
        const std::uint32_t j = (i + 2) % (2 * kSides);
        t.push_back({i, j, i + 1}), t.push_back({j, j + 1, i + 1});
    }
    MaterialConfig metal = lambert(0.9);
    metal.model = kModel<brdf::Metal>;
    metal.roughness = 0.45;
    return joined(plate(lambert(0.1), grid), object_of(v, t, metal, grid));
}

// The mean radiance of a strip of the paint to the right of the bar, beyond its shadow.
double light_beside_bar(const char* model, int samples, std::size_t places = 3000) {
    constexpr std::size_t kSize_px = 48;
    Stage s = stage_above(model, 4, samples, kSize_px);
    s.transfer.probes = places;
    s.add(paint_and_bar(s.grid), {0, 0, 4});
    s.sun({-1, 0, -3});
    s.render();
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < kSize_px * kSize_px; ++i) {
        const double x_m = (2 * (static_cast<double>(i % kSize_px) + 0.5) / kSize_px - 1) * kSeen_m;
        if (x_m > 0.24 && x_m < 0.31) sum += static_cast<double>(s.radiance.plane(0)[i]), ++count;
    }
    return sum / static_cast<double>(count);
}

// A place on a round bar is lit where it faces the Sun and seen where it does not, so each of its points sends light by its own
// normal. Fourteen tables, each with few places on the strip, have 1.24 times the light of random paths in the mean. With directions
// that a golden section turns from place to place they have a sixth more.
TEST(IrradianceCache, WhatIsLitOfABarDoesNotShineBehindIt) {
    double paths = 0;  // a single grid of rays is off by 8 %
    constexpr int kGrids = 12;
    for (int samples = 32; samples > 32 - kGrids; --samples)
        paths += (light_beside_bar("path", samples) - light_beside_bar("direct", samples)) / kGrids;
    EXPECT_GT(paths, 0);
    const double direct = light_beside_bar("direct", 4);
    double kept = 0;
    std::size_t places = 14000;
    constexpr int kTables = 14;
    for (int i = 0; i < kTables; ++i, places = places * 10 / 9)
        kept += (light_beside_bar("cached", 4, places) - direct) / kTables;
    EXPECT_NEAR(kept / paths, 1.24, 0.05);
}

// White paint: how many of a place's sixty directions meet the bar is chance, but where few do, places have what they have
// together with those beside them. The light of a pixel scatters about that of its block by 0.47 of the mean; by each place's own
// directions it is 1.14.
TEST(IrradianceCache, PaintBelowABarThatFewDirectionsMeetIsEven) {
    const PlateAndBar seen("cached", lambert(0.9), 0.03f, 4);
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
        const double off = seen.pixels[i] - seen.blocks[PlateAndBar::block_of(i)];
        sum += seen.pixels[i], squares += off * off;
    }
    ASSERT_GT(sum, 0);
    const auto count = static_cast<double>(seen.pixels.size());
    EXPECT_LT(std::sqrt(squares / count) / (sum / count), 0.6);
}

}  // namespace
}  // namespace hilcam
