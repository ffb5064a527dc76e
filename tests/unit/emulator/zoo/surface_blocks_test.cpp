#include "emulator/zoo/surface_blocks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sensor/camera_model.h"

namespace hilcam {
namespace {

constexpr int kPlateSide = 32;

ElectronImage even_plate(double charge_e) {
    ElectronImage image(kPlateSide, kPlateSide);
    for (float& e : image.all()) e = static_cast<float>(charge_e);
    return image;
}

// A camera right above a plate of 1 mm pixels, 1 m away, that fills columns and rows from `first` to `last`.
TruthLayers flat_plate(int first, int last) {
    TruthLayers layers;
    layers.object = IdImage(kPlateSide, kPlateSide), layers.part = IdImage(kPlateSide, kPlateSide);
    layers.normal = DirectionImage(kPlateSide, kPlateSide, 3),
    layers.position_m = LengthImage(kPlateSide, kPlateSide, 3);
    for (int y = first; y <= last; ++y)
        for (int x = first; x <= last; ++x) {
            const auto i = static_cast<std::size_t>(x);
            layers.object.row(y)[i] = layers.part.row(y)[i] = 1;
            layers.normal.row(y, 2)[i] = -1;
            layers.position_m.row(y, 0)[i] = 1e-3f * static_cast<float>(x);
            layers.position_m.row(y, 1)[i] = 1e-3f * static_cast<float>(y);
            layers.position_m.row(y, 2)[i] = 1;
        }
    return layers;
}

std::size_t smooth_px(const SurfacePixels& surface) {
    std::size_t count = 0;
    for (const std::uint8_t smooth : surface.smooth) count += smooth;
    return count;
}

TEST(SurfacePixels, APlateIsSmoothInsideItsRim) {
    const SurfacePixels surface = surface_pixels(flat_plate(4, 27));
    EXPECT_EQ(smooth_px(surface), 22u * 22u);
    EXPECT_TRUE(surface.is_smooth(5, 5));
    EXPECT_FALSE(surface.is_smooth(4, 10));
    EXPECT_TRUE(surface.is_near(0, 10));  // four columns beside it
    EXPECT_FALSE(surface_pixels(flat_plate(16, 20)).is_near(7, 16));
}

TEST(SurfacePixels, FoldsStepsAndOtherPartsAreNotSmooth) {
    // Each of these spoils columns 15 and 16 of the 22.
    TruthLayers folded = flat_plate(4, 27), stepped = flat_plate(4, 27), other = flat_plate(4, 27);
    const auto tilt = static_cast<float>(std::sin(0.3));  // 17 degrees
    for (int y = 4; y <= 27; ++y)
        for (std::size_t x = 16; x <= 27; ++x) {
            folded.normal.row(y, 0)[x] = tilt, folded.normal.row(y, 2)[x] = -std::sqrt(1 - tilt * tilt);
            stepped.position_m.row(y, 2)[x] = 1.002f;
            other.part.row(y)[x] = 2;
        }
    for (const TruthLayers* layers : {&folded, &stepped, &other})
        EXPECT_EQ(smooth_px(surface_pixels(*layers)), 20u * 22u);
}

TEST(SurfacePixels, ACylinderOfManyPixelsIsSmooth) {
    TruthLayers layers = flat_plate(4, 27);
    for (int y = 4; y <= 27; ++y)
        for (int x = 4; x <= 27; ++x) {
            // Normals turn by 3 degrees a pixel.
            const double angle = 0.052 * (x - 15.5);
            const auto i = static_cast<std::size_t>(x);
            layers.normal.row(y, 0)[i] = static_cast<float>(std::sin(angle));
            layers.normal.row(y, 2)[i] = static_cast<float>(-std::cos(angle));
            layers.position_m.row(y, 0)[i] = static_cast<float>(1e-3 / 0.052 * std::sin(angle));
            layers.position_m.row(y, 2)[i] = static_cast<float>(1 - 1e-3 / 0.052 * std::cos(angle));
        }
    EXPECT_EQ(smooth_px(surface_pixels(layers)), 22u * 22u);
}

class Blocks : public testing::Test {
  protected:
    Blocks() {
        camera_.read_noise_e = 10, camera_.gain_dn_e = 1;
        camera_.has_gain_dn_e = true;
        surface_.width = surface_.height = kPlateSide;
        surface_.smooth.assign(kPlateSide * kPlateSide, 1),
            surface_.near_object.assign(kPlateSide * kPlateSide, 1);
    }
    BlockCounts counts(const ElectronImage& picture, const ElectronImage& reference, double error_e) const {
        return block_counts(picture, {reference, even_plate(20), even_plate(error_e)}, surface_,
                            SensorNoise(camera_, 0));
    }
    CameraModel camera_;
    SurfacePixels surface_;
};

// 64 blocks, the k-th of them off by k per cent: 54 by more than ten and a half per cent, 39 by more than 25.
TEST_F(Blocks, AreCountedByHowFarTheirLightIsOff) {
    const ElectronImage reference = even_plate(1020);
    ElectronImage picture = even_plate(1020);
    for (int y = 0; y < kPlateSide; ++y)
        for (int x = 0; x < kPlateSide; ++x) {
            const int k = y / 4 * 8 + x / 4;
            // Within a block half the pixels are off by more than its mean, half by less.
            const double off_e = 10 * (k + 0.5) + (x % 2 == 0 ? 200 : -200);
            picture.row(y)[static_cast<std::size_t>(x)] += static_cast<float>(y % 8 < 4 ? off_e : -off_e);
        }
    const BlockCounts found = counts(picture, reference, 1);
    EXPECT_EQ(found.judged, 64u);
    EXPECT_EQ(found.unknown, 0u);
    EXPECT_EQ(found.over_10, 54u);
    EXPECT_EQ(found.over_25, 39u);
}

// The error of a block's sum is 4 times a pixel's: a fortieth of 16 x 1000 e- is 100 e- a pixel.
TEST_F(Blocks, WhatTheReferenceDoesNotKnowIsNotJudged) {
    EXPECT_EQ(counts(even_plate(1200), even_plate(1020), 99).judged, 64u);
    const BlockCounts unknown = counts(even_plate(1200), even_plate(1020), 101);
    EXPECT_EQ(unknown.judged, 0u);
    EXPECT_EQ(unknown.unknown, 64u);
    EXPECT_EQ(unknown.over_10, 0u);
}

TEST_F(Blocks, OnlyLitSmoothSurfaceCounts) {
    // Five times the noise in the dark, sqrt(20 + 100 + 1/12) = 10.96 e-, is 54.8 e- of light.
    EXPECT_EQ(counts(even_plate(200), even_plate(20 + 54), 0).judged, 0u);
    EXPECT_EQ(counts(even_plate(200), even_plate(20 + 56), 0).judged, 64u);
    surface_.smooth[5 * kPlateSide + 9] = 0;
    EXPECT_EQ(counts(even_plate(200), even_plate(1020), 0).judged, 63u);
}

}  // namespace
}  // namespace hilcam
