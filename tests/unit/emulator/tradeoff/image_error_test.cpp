#include "emulator/tradeoff/image_error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hilcam {
namespace {

ElectronImage even(int size, double charge_e) {
    ElectronImage image(size, size);
    for (float& e : image.all()) e = static_cast<float>(charge_e);
    return image;
}

// A Gaussian spot, sampled at the middles of pixels, on `dark_e`.
ElectronImage spot(int size, double x_px, double y_px, double peak_e, double dark_e) {
    constexpr double kSigma_px = 3;
    ElectronImage image(size, size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const double r2 = std::pow(x + 0.5 - x_px, 2) + std::pow(y + 0.5 - y_px, 2);
            image.row(y)[static_cast<std::size_t>(x)] =
                static_cast<float>(dark_e + peak_e * std::exp(-r2 / (2 * kSigma_px * kSigma_px)));
        }
    return image;
}

CameraModel quiet_camera() {
    CameraModel c;
    c.read_noise_e = 10;
    c.gain_dn_e = 1;
    c.has_gain_dn_e = true;
    return c;
}

TEST(ImageError, CentreOfAShiftedGaussianMovesByTheShift) {
    // Samples of a Gaussian of 3 px have the integral's moments to exp(-2 pi^2 9); single precision leaves
    // 1e-7 of 1000 e- in each of 4096 pixels, some 20 px from the middle: below 1e-4 px.
    const ElectronImage dark = even(64, 7);
    const PixelBox all{0, 0, 64, 64};
    const auto a = window_light(spot(64, 30.2, 33.7, 1000, 7), dark, all);
    const auto b = window_light(spot(64, 30.5, 33.3, 1000, 7), dark, all);
    ASSERT_TRUE(a && b);
    EXPECT_NEAR(a->x_px, 30.2, 1e-4);
    EXPECT_NEAR(a->y_px, 33.7, 1e-4);
    EXPECT_NEAR(b->x_px - a->x_px, 0.3, 1e-4);
    EXPECT_NEAR(b->y_px - a->y_px, -0.4, 1e-4);
}

TEST(ImageError, LightOfAWindowIsWhatIsAboveTheDark) {
    const double integral_e = 2 * 3.14159265358979 * 9 * 1000;
    const ElectronImage dark = even(64, 7);
    EXPECT_NEAR(window_light(spot(64, 32, 32, 1000, 7), dark, {0, 0, 64, 64})->total_e / integral_e, 1, 1e-5);
    // Half of it, by symmetry.
    EXPECT_NEAR(window_light(spot(64, 32, 32, 1000, 7), dark, {0, 0, 32, 64})->total_e / integral_e, 0.5,
                1e-5);
    EXPECT_FALSE(window_light(dark, dark, {0, 0, 64, 64}));
}

TEST(ImageError, IsInUnitsOfEachPixelsOwnNoise) {
    const CameraModel camera = quiet_camera();
    const SensorNoise noise(camera, 0);
    const ElectronImage dark = even(20, 0);
    const ElectronImage reference = spot(20, 10, 10, 5000, 2000);
    for (const double off : {0.4, -0.6}) {
        ElectronImage image(20, 20);
        for (std::size_t i = 0; i < image.pixels(); ++i) {
            const auto e = static_cast<double>(reference.data()[i]);
            image.data()[i] = static_cast<float>(e + off * std::sqrt(e + 100 + 1.0 / 12));
        }
        const NoiseError error = noise_error(image, reference, dark, noise);
        EXPECT_NEAR(error.p99, std::abs(off), 1e-5);
        EXPECT_NEAR(error.rms, std::abs(off), 1e-5);
        EXPECT_EQ(error.within_half_fraction, off > -0.5 ? 1 : 0);
        EXPECT_EQ(error.lit_px, 400u);
    }
}

TEST(ImageError, NinetyNineOfAHundredLitPixelsAreNotFartherOffThanP99) {
    const CameraModel camera = quiet_camera();
    const SensorNoise noise(camera, 0);
    const ElectronImage dark = even(20, 0);
    // A hundred lit pixels, the k-th off by k sigma; the others have less light than the dark's noise of 10
    // e-.
    ElectronImage reference = even(20, 5), image = even(20, 9);
    double squares = 0;
    for (int k = 1; k <= 100; ++k) {
        const auto i = static_cast<std::size_t>(3 * k);
        reference.data()[i] = 1e6f;
        image.data()[i] = static_cast<float>(1e6 - k * noise.sigma_e(1e6, 0));
        squares += k * k;
    }
    const NoiseError error = noise_error(image, reference, dark, noise);
    EXPECT_EQ(error.lit_px, 100u);
    EXPECT_NEAR(error.p99, 99, 1e-3);
    EXPECT_NEAR(error.rms, std::sqrt(squares / 100), 1e-3);
    EXPECT_EQ(error.within_half_fraction, 0);
}

TEST(ImageError, LightWhereTheReferenceIsDarkCounts) {
    const CameraModel camera = quiet_camera();
    const SensorNoise noise(camera, 0);
    const ElectronImage dark = even(4, 0);
    ElectronImage image = even(4, 0);
    image.data()[5] = 1000;
    const NoiseError error = noise_error(image, dark, dark, noise);
    EXPECT_EQ(error.lit_px, 1u);
    EXPECT_NEAR(error.p99, 1000 / noise.sigma_e(0, 0), 1e-4);
    EXPECT_EQ(noise_error(dark, dark, dark, noise).lit_px, 0u);
}

TEST(ImageError, PixelsOfSeveralPicturesAreAsOfOne) {
    const CameraModel camera = quiet_camera();
    const SensorNoise noise(camera, 0);
    const ElectronImage dark = even(4, 0), reference = spot(4, 2, 2, 5000, 2000);
    const ElectronImage near = spot(4, 2, 2, 5100, 2000), far = spot(4, 2, 2, 5400, 2000);
    std::vector<double> both = lit_errors({near, reference, reference, dark}, noise);
    const std::vector<double> second = lit_errors({far, reference, reference, dark}, noise);
    both.insert(both.end(), second.begin(), second.end());
    const NoiseError a = noise_error(near, reference, dark, noise),
                     b = noise_error(far, reference, dark, noise), all = noise_error(both);
    EXPECT_EQ(all.lit_px, 32u);
    EXPECT_NEAR(all.rms, std::sqrt((a.rms * a.rms + b.rms * b.rms) / 2), 1e-12);
    EXPECT_DOUBLE_EQ(all.p99, b.p99);
}

// Two renderings that miss the light by turns: where the truth is lit the pixel counts, and its noise is the
// measure.
TEST(ImageError, ScatterIsInTheTruthsNoiseOverAllThatIsLit) {
    const CameraModel camera = quiet_camera();
    const SensorNoise noise(camera, 0);
    const ElectronImage dark = even(4, 0), truth = even(4, 1000), none = even(4, 0);
    ElectronImage one = even(4, 0), other = even(4, 0);
    one.data()[3] = 4000, other.data()[9] = 2000;
    std::vector<double> scatter = lit_errors({one, other, truth, dark}, noise);
    ASSERT_EQ(scatter.size(), 16u);
    EXPECT_DOUBLE_EQ(scatter[3], 4000 / noise.sigma_e(1000, 0));
    EXPECT_DOUBLE_EQ(scatter[9], 2000 / noise.sigma_e(1000, 0));
    EXPECT_EQ(scatter[0], 0);
    EXPECT_EQ(lit_errors({one, other, none, dark}, noise).size(), 2u);
}

TEST(ImageError, AFalseLightIsBrightWhereTheTruthIsDark) {
    const CameraModel camera = quiet_camera();
    const SensorNoise noise(camera, 0);
    const ElectronImage dark = even(10, 30);
    ElectronImage reference = even(10, 30), image = even(10, 30);
    const auto both = [&](std::size_t i, double true_e, double seen_e) {
        reference.data()[i] = static_cast<float>(true_e), image.data()[i] = static_cast<float>(seen_e);
    };
    // sigma: sqrt(30 + 100 + 1/12) = 11.41 e- in the dark, sqrt(129 + ...) = 15.14 at 99 e- of light.
    both(0, 30, 30 + 58), both(1, 129, 129 + 77);  // above 57.0 and 75.7
    EXPECT_EQ(false_lights(image, reference, dark, noise), 2u);
    both(2, 30, 30 + 56), both(3, 129, 129 + 74);  // within five sigma
    both(4, 30 + 101, 5000);                       // there is a light, if not so bright
    both(5, 99, 0);                                // darkness is no light
    both(6, 5000, 5000);                           // as it should be
    EXPECT_EQ(false_lights(image, reference, dark, noise), 2u);
    EXPECT_EQ(false_lights(reference, reference, dark, noise), 0u);
}

TEST(ImageError, WhatNoFrameShowsIsTakenOff) {
    ElectronImage image = even(3, 500);
    image.data()[4] = 20000;
    saturate(image, 12000);
    EXPECT_EQ(image.data()[4], 12000);
    EXPECT_EQ(image.data()[0], 500);
}

}  // namespace
}  // namespace hilcam
