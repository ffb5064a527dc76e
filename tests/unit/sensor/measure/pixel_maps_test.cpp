#include "sensor/measure/pixel_maps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace hilcam {
namespace {

// Two stacks: the line through both points, with textbook variances.
TEST(PixelMaps, ALineThroughTwoStacksIsExact) {
    const std::vector<double> time = {1, 3}, variance = {0.04, 0.09};
    const LineWeights w = line_weights(time, variance);
    const auto at = [&](const std::vector<double>& weights) { return weights[0] * 12 + weights[1] * 20; };
    EXPECT_NEAR(at(w.offset), 8, 1e-12);
    EXPECT_NEAR(at(w.rate), 4, 1e-12);
    EXPECT_NEAR(w.rate_variance, (0.04 + 0.09) / 4, 1e-12);
    EXPECT_NEAR(w.offset_variance, (9 * 0.04 + 1 * 0.09) / 4, 1e-12);
    EXPECT_NEAR(w.covariance, -(3 * 0.04 + 1 * 0.09) / 4, 1e-12);
}

struct MadeUpMap {
    static constexpr int kSide = 200;
    std::vector<double> truth, measured;
    PixelSelection good{0, 0, kSide, kSide};

    MadeUpMap(double pixel, double column, double noise) {
        std::mt19937_64 engine(5);
        std::normal_distribution<double> normal;
        std::vector<double> columns(kSide);
        for (double& c : columns) c = column * normal(engine);
        for (int i = 0; i < kSide * kSide; ++i) {
            truth.push_back(10 + pixel * normal(engine) + columns[static_cast<std::size_t>(i % kSide)]);
            measured.push_back(truth.back() + noise * normal(engine));
        }
    }
};

// A map with errors as large as its pixels: the spread comes back, to 4 standard errors of 40,000 values, and
// the correlation is that of signal and noise.
TEST(PixelMaps, TheSpreadOfAMapIsTheTrueOne) {
    MadeUpMap map(2, 1, 2);
    map.good.use[77] = 0, map.measured[77] = 5000;
    const MapSpread spread = map_spread(map.measured, map.good, 4, 0);
    EXPECT_NEAR(spread.pixel(), 4, 4 * 8 * std::sqrt(2.0 / 40'000));
    EXPECT_NEAR(spread.correlation(), std::sqrt(5.0 / 9), 0.02);
    const std::vector<double> shrunk = with_true_spread(map.measured, map.good, spread);
    const SpatialParts parts = spatial_parts(shrunk, map.good);
    EXPECT_NEAR(std::sqrt(parts.pixel), 2, 0.05);
    // 200 columns: a standard deviation to 5 %.
    EXPECT_NEAR(std::sqrt(parts.column), 1, 0.2);
    EXPECT_EQ(shrunk[77], 5000);
    EXPECT_GT(std::sqrt(spatial_parts(map.measured, map.good).pixel), 2.7);
}

TEST(PixelMaps, AMapOfNothingButErrorsBecomesFlat) {
    const MadeUpMap map(0, 0, 1);
    const MapSpread spread = map_spread(map.measured, map.good, 1.02, 0);
    EXPECT_EQ(spread.correlation(), 0);
    const std::vector<double> flat = with_true_spread(map.measured, map.good, spread);
    EXPECT_LT(std::sqrt(spatial_parts(flat, map.good).total), 0.02);
}

TEST(PixelMaps, ABlinkingPixelsStatesAreTold) {
    std::mt19937_64 engine(9);
    std::normal_distribution<double> normal;
    std::vector<double> values;
    for (int i = 0; i < 64; ++i) values.push_back(100 + ((i / 4) % 3 == 0 ? 12 : 0) + normal(engine));
    const TwoStates states = two_states(values, 1);
    // 24 high values, 40 low ones.
    EXPECT_NEAR(states.uncertainty_dn, std::sqrt(1.0 / 24 + 1.0 / 40), 0.01);
    EXPECT_NEAR(states.high_dn - states.low_dn, 12, 4 * states.uncertainty_dn);
    EXPECT_EQ(states.changes, 10);
}

}  // namespace
}  // namespace hilcam
