#include "emulator/zoo/grid_energy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "render/vocabulary/random.h"

namespace hilcam {
namespace {

constexpr int kGridSide = 320;

// Numbers without any order, between -1/2 and 1/2, by a place and a draw.
double any(std::uint64_t draw, int x, int y) {
    std::uint64_t h = draw * 0x9E3779B97F4A7C15u ^ static_cast<std::uint64_t>(x) * 0xC2B2AE3D27D4EB4Fu ^
                      static_cast<std::uint64_t>(y) * 0x165667B19E3779F9u;
    h = (h ^ (h >> 33)) * 0xFF51AFD7ED558CCDu;
    h = (h ^ (h >> 29)) * 0xC4CEB9FE1A85EC53u;
    return static_cast<double>((h ^ (h >> 32)) >> 11) * 0x1p-53 - 0.5;
}

// The energy of a picture of values, all of which count.
GridEnergy energy_of(
    const std::function<double(int x, int y)>& value,
    const std::function<bool(int x, int y)>& counts = [](int, int) { return true; }) {
    std::vector<float> values;
    std::vector<std::uint8_t> mask;
    for (int y = 0; y < kGridSide; ++y)
        for (int x = 0; x < kGridSide; ++x) {
            values.push_back(static_cast<float>(value(x, y)));
            mask.push_back(counts(x, y) ? 1 : 0);
        }
    return grid_energy({kGridSide, kGridSide, values, mask});
}

// A power of a white picture is distributed as an exponential one. The ratio's numerator has six of them, its
// denominator the mean of some 48; over eight pictures 48 and 384, so its standard deviation is 0.15.
TEST(GridEnergy, NoiseFollowsNoGrid) {
    GridEnergy sum;
    for (std::uint64_t draw = 0; draw < 8; ++draw)
        sum += energy_of([draw](int x, int y) { return any(draw, x, y); });
    EXPECT_NEAR(sum.ratio(), 1, 4 * 0.15);
}

// Squares of random brightness in as much noise: their borders are where the grid says.
TEST(GridEnergy, SquaresOnTheGridAreSeenAtTheirPeriod) {
    for (std::size_t p = 0; p < kGridPeriods_px.size(); ++p) {
        const int size = kGridPeriods_px[p];
        const GridEnergy energy =
            energy_of([size](int x, int y) { return any(1, x, y) + any(2, x / size, y / size); });
        EXPECT_GT(energy.ratio(p), 15) << size;
        EXPECT_GT(energy.ratio(), 10) << size;
    }
}

TEST(GridEnergy, SquaresOfAnotherSizeAreNot) {
    const GridEnergy energy = energy_of([](int x, int y) { return any(1, x, y) + any(2, x / 7, y / 7); });
    EXPECT_LT(energy.ratio(), 2.5);
}

// Where squares lie does not matter, nor whether they are stripes, nor which way those go. Forty random heights have as many steps, whose
// own scatter is at the neighbouring frequencies.
TEST(GridEnergy, BarsAlongRowsAreSeenWhereverTheyBegin) {
    const auto bars = [](int x, int y) { return any(1, x, y) + 0.5 * any(2, 0, (y + 5) / 8); };
    EXPECT_GT(energy_of(bars).ratio(0), 4);
    const auto columns = [&](int x, int y) { return bars(y, x); };
    EXPECT_GT(energy_of(columns).ratio(0), 4);
}

// One pixel of two hundred is off by a hundred times the rest, as fireflies of a reference are.
TEST(GridEnergy, FewPixelsThatAreFarOffDoNotDrownThePattern) {
    const GridEnergy energy = energy_of(
        [](int x, int y) { return any(1, x, y) + any(2, x / 8, y / 8) + (any(3, x, y) > 0.495 ? 100 : 0); });
    EXPECT_GT(energy.ratio(0), 30);
}

TEST(GridEnergy, AChessboardIsSeen) {
    const GridEnergy energy =
        energy_of([](int x, int y) { return any(1, x, y) + ((x / 8 + y / 8) % 2 == 0 ? 0.2 : -0.2); });
    EXPECT_GT(energy.ratio(0), 30);
}

// Outlines of what counts are no steps, as the pixels beside them do not count.
TEST(GridEnergy, WhatDoesNotCountIsNotLookedAt) {
    const auto hidden = [](int x, int y) { return x % 8 == 3 || y % 8 == 3; };
    const GridEnergy energy = energy_of([&](int x, int y) { return hidden(x, y) ? 1000 : any(1, x, y); },
                                        [&](int x, int y) { return !hidden(x, y); });
    // Only steps that are there make energy: without the hidden ones it is that of noise in gaps.
    EXPECT_LT(energy.at[0], 1e4);
    const GridEnergy nothing =
        energy_of([](int x, int y) { return any(1, x, y); }, [](int, int) { return false; });
    EXPECT_EQ(nothing.ratio(), 0);
}

TEST(GridEnergy, APictureWithoutErrorHasNone) {
    EXPECT_EQ(energy_of([](int, int) { return 0.0; }).ratio(), 0);
    EXPECT_EQ(energy_of([](int, int) { return 3.0; }).ratio(), 0);
}

}  // namespace
}  // namespace hilcam
