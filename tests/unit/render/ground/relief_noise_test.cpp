#include "render/ground/relief_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/vector_widths.h"

namespace hilcam {
namespace {

std::vector<Vec3d> places(std::size_t count) {
    std::vector<Vec3d> out;
    for (std::size_t i = 0; i < count; ++i) {
        const auto k = static_cast<double>(i);
        out.push_back({37.3 * std::sin(0.7 * k), -1e4 * std::cos(1.3 * k), 0.31 * k - 40});
    }
    return out;
}

std::vector<double> heights_of(const ReliefWave& wave, const std::vector<Vec3d>& at) {
    std::vector<double> heights_m(at.size(), 1.5);
    add_wave(wave, at, heights_m);
    return heights_m;
}

constexpr ReliefWave kWave{3, 4, 0.8, {0.37, 0.2, -0.4}, 2.5};

TEST(ReliefNoise, IsTheSameWithVectorsOfAnyWidth) {
    expect_same_by_any_width([] { return heights_of(kWave, places(1003)); });
}

// However many places are asked for together, each has its own height, added to what it had.
TEST(ReliefNoise, EachPlaceHasItsOwnHeight) {
    const std::vector<Vec3d> all = places(21);
    const std::vector<double> together = heights_of(kWave, all);
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(heights_of(kWave, {all[i]})[0], together[i]) << i;
}

// Gradient noise is nothing at the lattice's corners and smooth between them: its second derivative, too, has no step there.
TEST(ReliefNoise, IsSmoothThroughTheLattice) {
    const ReliefWave wave{1, 0, 1, {}, 1};
    const auto at = [&](Vec3d place) { return heights_of(wave, {place})[0] - 1.5; };
    double most = 0;
    for (int k = -20; k < 20; ++k) {
        EXPECT_EQ(at({1.0 * k, 3, -7}), 0);
        const double x = k, h = 1e-3;
        const auto bend = [&](double to) {
            return (at({to - h, 3.4, -6.7}) - 2 * at({to, 3.4, -6.7}) + at({to + h, 3.4, -6.7})) / (h * h);
        };
        EXPECT_NEAR(bend(x - 2 * h), bend(x + 2 * h), 0.3);
        most = std::max(most, std::abs(at({x + 0.5, 3.4, -6.7})));
    }
    EXPECT_GT(most, 0.2);
    EXPECT_LT(most, 1.1);
}

}  // namespace
}  // namespace hilcam
