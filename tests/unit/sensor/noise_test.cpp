#include "sensor/noise.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/cameras.h"
#include "tests/support/statistics.h"

namespace hilcam {
namespace {

Moments electrons(float mean_e, float read_noise_e, std::size_t count) {
    const std::vector<float> in(count, mean_e);
    std::vector<float> charge(count), deviates(count);
    draw_pixels(in, {3, 4}, 0, charge, deviates);
    for (std::size_t i = 0; i < count; ++i) charge[i] += read_noise_e * deviates[i];
    return moments_of(charge);
}

TEST(Noise, ShotNoiseHasPoissonsMeanAndVarianceAtEveryLevel) {
    constexpr std::size_t kCount = 400000;
    for (const float mean : {0.01f, 0.5f, 3.0f, 20.0f, 31.9f, 32.0f, 100.0f, 5000.0f}) {
        const Moments m = electrons(mean, 0, kCount);
        const double lambda = static_cast<double>(mean), n = kCount;
        // 4.5 standard errors of 16 figures: one false alarm in 10^4 runs. Var of a Poisson variance: (2 l^2
        // + l)/n.
        EXPECT_NEAR(m.mean, lambda, 4.5 * std::sqrt(lambda / n) + 1e-3) << mean;
        EXPECT_NEAR(m.variance, lambda, 4.5 * std::sqrt((2 * lambda * lambda + lambda) / n) + 0.003 * lambda)
            << mean;
    }
}

// Chi-square over the counts of a Poisson of mean 4, and the same statistic for a wrong model, which it must
// refuse.
TEST(Noise, SmallCountsFollowPoissonsDistribution) {
    constexpr std::size_t kCount = 100000;
    const auto chi_square = [&](double model_mean) {
        const std::vector<float> in(kCount, 4.0f);
        std::vector<float> out(kCount);
        draw_pixels(in, {11, 2}, 0, out, {});
        std::array<double, 12> seen{};
        for (const float v : out) seen[std::min(static_cast<std::size_t>(v), std::size_t{11})] += 1;
        double statistic = 0, left = 1, probability = std::exp(-model_mean);
        for (std::size_t k = 0; k < 12; ++k) {
            const double expected = kCount * (k == 11 ? left : probability);
            statistic += (seen[k] - expected) * (seen[k] - expected) / expected;
            left -= probability;
            probability *= model_mean / static_cast<double>(k + 1);
        }
        return statistic;
    };
    // 11 degrees of freedom: 31.3 is exceeded once in 1000.
    EXPECT_LT(chi_square(4.0), 31.3);
    EXPECT_GT(chi_square(4.05), 31.3);
}

TEST(Noise, ReadNoiseAddsItsVariance) {
    constexpr double n = 400000;
    const Moments m = electrons(0, 10, 400000);
    EXPECT_NEAR(m.mean, 0, 4 * 10 / std::sqrt(n) + 1e-3);
    EXPECT_NEAR(m.variance, 100, 4 * 100 * std::sqrt(2 / n));
}

TEST(Noise, QuantileMatchesTheTable) {
    // Abramowitz & Stegun, table 26.1.
    EXPECT_NEAR(normal_quantile(0.5f), 0, 1e-6);
    EXPECT_NEAR(normal_quantile(0.975f), 1.959964, 1e-4);
    EXPECT_NEAR(normal_quantile(0.001349898f), -3.0, 1e-3);
    EXPECT_NEAR(normal_quantile(2.866516e-7f), -5.0, 1e-2);
}

TEST(Noise, APixelCanBeRecomputedAlone) {
    std::vector<float> in(300, 50.0f), all(300), deviates(300), one(1), deviate(1);
    in[0] = NAN;
    for (const std::uint32_t first : {1000u, 1001u}) {
        draw_pixels(in, {7, 8}, first, all, deviates);
        EXPECT_EQ(all[0], 0);
        for (const std::uint32_t i : {1u, 2u, 127u, 128u, 298u, 299u}) {
            draw_pixels(std::span(in).subspan(i, 1), {7, 8}, first + i, one, deviate);
            EXPECT_EQ(all[i], one[0]) << first << ' ' << i;
            EXPECT_EQ(deviates[i], deviate[0]) << first << ' ' << i;
        }
    }
}

// Far above the inversion the counts are still Poisson's: Kolmogorov's statistic against the sum of its
// probabilities, and against a Poisson of another mean, which must be refused.
TEST(Noise, LargeCountsFollowPoissonsDistribution) {
    constexpr std::size_t kCount = 50000;
    for (const double mean : {40.0, 400.0, 10000.0}) {
        const std::vector<float> in(kCount, static_cast<float>(mean));
        std::vector<float> out(kCount);
        draw_pixels(in, {5, 6}, 0, out, {});
        // Half a count is added: the distribution is discrete, its steps are counted in the middle.
        const auto statistic = [&](double model_mean) {
            std::vector<double> seen(out.begin(), out.end());
            std::sort(seen.begin(), seen.end());
            double most = 0, cumulative = 0;
            const double low = std::max(0.0, std::floor(model_mean - 8 * std::sqrt(model_mean)));
            for (double k = low; k < model_mean + 8 * std::sqrt(model_mean); k += 1) {
                cumulative += std::exp(k * std::log(model_mean) - model_mean - std::lgamma(k + 1));
                const auto below = std::upper_bound(seen.begin(), seen.end(), k) - seen.begin();
                most = std::max(most, std::abs(static_cast<double>(below) / kCount - cumulative));
            }
            return most * std::sqrt(static_cast<double>(kCount));
        };
        EXPECT_LT(statistic(mean), kKolmogorov_1_in_1000) << mean;
        EXPECT_GT(statistic(mean + 0.03 * std::sqrt(mean)), kKolmogorov_1_in_1000) << mean;
    }
}

TEST(Noise, ReadNoiseIsNormal) {
    std::vector<float> deviates(200000);
    draw_pixels({}, {9, 9}, 3, {}, deviates);
    const std::vector<double> samples(deviates.begin(), deviates.end());
    EXPECT_LT(kolmogorov(samples, normal_cdf), kKolmogorov_1_in_1000);
    EXPECT_GT(kolmogorov(samples, [](double x) { return normal_cdf(x / 1.02); }), kKolmogorov_1_in_1000);
}

TEST(Noise, APoissonNumberOfEventsHasItsMeanAndVariance) {
    for (const double mean : {0.3, 7.0, 300.0, 5000.0}) {
        std::vector<double> counts;
        for (int i = 0; i < 20000; ++i) counts.push_back(poisson_count(mean, (i + 0.5) / 20000));
        // The uniform numbers are the middles of equal cells: only the tails are rough.
        EXPECT_NEAR(moments_of(counts).mean, mean, 2e-3 * mean) << mean;
        EXPECT_NEAR(moments_of(counts).variance, mean, 0.01 * mean) << mean;
    }
    EXPECT_EQ(poisson_count(0, 0.5), 0u);
    EXPECT_EQ(poisson_count(-1, 0.5), 0u);
}

// Pairs of frames of a flat: variance over mean is the gain, what is left at no light the dark noise.
TEST(Noise, PhotonTransferGivesGainAndDarkNoise) {
    CameraModel c = camera_64();
    c.width_px = c.height_px = 256;
    c.gain_dn_e = 0.4, c.offset_dn = 100, c.read_noise_e = 9, c.reset_noise_e = 4, c.full_well_e = 1e4;
    Bench bench(c);
    const auto variance = [&](float mean_e) {
        const DnImage& a = bench.digitise_flat(mean_e, 1);
        std::vector<double> difference(a.all().begin(), a.all().end());
        const DnImage& b = bench.digitise_flat(mean_e, 2);
        for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= b.all()[i];
        return moments_of(difference).variance / 2;
    };
    const double dark = variance(0), lit = variance(5000);
    // A variance from n pixels has the relative error sqrt(2 / n) = 0.55 %; 4 of them.
    EXPECT_NEAR(dark, 0.16 * (81 + 16) + 1.0 / 12, 0.022 * dark);
    EXPECT_NEAR(lit - dark, 0.16 * 5000, 0.022 * lit);
}

}  // namespace
}  // namespace hilcam
