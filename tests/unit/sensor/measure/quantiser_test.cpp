#include "sensor/measure/quantiser.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace hilcam {
namespace {

TEST(Quantiser, WideNoiseGetsATwelfth) {
    for (const double mean : {100.0, 100.25, 100.5}) {
        const RoundedMoments m = rounded_moments(mean, 2);
        EXPECT_NEAR(m.mean, mean, 1e-12);
        EXPECT_NEAR(m.variance, 4 + 1.0 / 12, 1e-12);
    }
}

// Without noise a value is a whole number. With a little, one halfway between two is either of them half of
// the time: a variance of 1/4.
TEST(Quantiser, NarrowNoiseDependsOnThePlaceBetweenTwoNumbers) {
    EXPECT_EQ(rounded_moments(3.2, 0).mean, 3);
    EXPECT_EQ(rounded_moments(3.2, 0).variance, 0);
    EXPECT_NEAR(rounded_moments(3.5, 0.05).mean, 3.5, 1e-9);
    EXPECT_NEAR(rounded_moments(3.5, 0.05).variance, 0.25, 1e-9);
    EXPECT_NEAR(rounded_moments(3.0, 0.05).variance, 0, 1e-9);
}

// The first term of the series of Widrow, Kollar & Liu (1996): the mean deviates by
// -sin(2 pi mean) exp(-2 pi^2 sigma^2) / pi.
TEST(Quantiser, TheMeanFollowsThePublishedSeries) {
    constexpr double kPi_here = 3.14159265358979;
    for (const double mean : {10.1, 10.3, 10.8})
        EXPECT_NEAR(rounded_moments(mean, 0.5).mean - mean,
                    -std::sin(2 * kPi_here * mean) * std::exp(-2 * kPi_here * kPi_here * 0.25) / kPi_here,
                    1e-7);
}

// Pixels with means spread over a fifth of a step, and noise of 0.35 DN: the standard's 1/12 would be wrong
// by more than ten standard errors.
TEST(Quantiser, NoiseBelowAStepComesBackFromRoundedNumbers) {
    constexpr int kPixels = 40'000, kSamples = 50;
    constexpr double kSigma = 0.35;
    std::mt19937_64 engine(3);
    std::normal_distribution<double> normal;
    PixelSelection selection(0, 0, kPixels, 1);
    std::vector<double> mean(kPixels);
    double variance = 0;
    for (double& pixel : mean) {
        const double true_mean = 64.1 + 0.05 * normal(engine);
        double sum = 0, square = 0;
        for (int i = 0; i < kSamples; ++i) {
            const double value = std::floor(true_mean + kSigma * normal(engine) + 0.5);
            sum += value, square += value * value;
        }
        pixel = sum / kSamples;
        variance += (square - sum * sum / kSamples) / (kSamples - 1) / kPixels;
    }
    // The relative error of a variance of 2e6 samples is 1e-3. The means are known to 0.06 DN, which blurs
    // their places between two numbers and takes 8 % off the correction's first harmonic: 1.6 % here.
    const double found = variance_before_rounding_dn2(mean, selection, variance);
    EXPECT_NEAR(found / (kSigma * kSigma), 1, 0.02);
    EXPECT_GT(std::abs((variance - 1.0 / 12) / (kSigma * kSigma) - 1), 0.05);
}

TEST(Quantiser, NoiseThatReachesNoStepIsNone) {
    const std::vector<double> mean(100, 64.0);
    EXPECT_EQ(variance_before_rounding_dn2(mean, {0, 0, 100, 1}, 0), 0);
}

}  // namespace
}  // namespace hilcam
