#include "render/sky/body_heat.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

const SpectralGrid kGrid({1, 2.5, 3, 5, 8, 14});

// An even globe shows pi B (R/d)^2 at every phase.
TEST(BodyHeat, AnEvenGlobeHasNoPhases) {
    const BodyHeat heat({254, 254, 0.9}, kGrid);
    const Spectrum black = planck_w_m2_sr_um(kGrid, 254);
    for (const double phase_deg : {0.0, 60.0, 179.0})
        for (int b = 1; b < kGrid.size(); ++b)
            EXPECT_NEAR(heat.disk_w_m2_um(phase_deg * kDegree_rad)[b] / (kPi * 0.9 * black[b]), 1, 2e-3);
    EXPECT_EQ(heat.radiance({1})[0], 0);  // not thermal
}

// The Moon at noon, at 60 degrees from it and at night: the fourth root of the cosine.
TEST(BodyHeat, AGreyMoonIsInEquilibriumWithItsSun) {
    const BodyHeat heat({385, 95, 0.95}, kGrid);
    const double middle = std::pow(0.5 * (std::pow(385.0, 4) + std::pow(95.0, 4)), 0.25);
    for (const auto& [mu0, kelvin] : {std::pair{1.0f, 385.0}, {0.5f, middle}, {0.0f, 95.0}, {-0.3f, 95.0}}) {
        const Spectrum black = planck_w_m2_sr_um(kGrid, kelvin);
        EXPECT_NEAR(heat.radiance({mu0})[4] / (0.95f * black[4]), 1, 2e-3) << kelvin;
    }
}

// By squares of the disk, where the table goes by chords.
void expect_disk_is_sum(const BodyHeat& heat) {
    for (const double phase_deg : {0.0, 45.0, 90.0, 150.0}) {
        const double g = phase_deg * kDegree_rad;
        constexpr int kAcross = 600;
        Spectrum sum;
        for (int j = 0; j < kAcross; ++j)
            for (int i = 0; i < kAcross; ++i) {
                const double x = (2 * i + 1.0) / kAcross - 1, y = (2 * j + 1.0) / kAcross - 1;
                if (x * x + y * y >= 1) continue;
                const double z = std::sqrt(1 - x * x - y * y);
                BodyHeat::Place place{static_cast<float>(x * std::sin(g) + z * std::cos(g)),
                                      static_cast<float>(y), static_cast<float>(std::atan2(x, z) - g)};
                sum += 2.0f / (kAcross * kAcross) * heat.radiance(place);
                place.hour_rad = -place.hour_rad;
                sum += 2.0f / (kAcross * kAcross) * heat.radiance(place);
            }
        for (int b = 2; b < kGrid.size(); ++b)
            EXPECT_NEAR(sum[b] / heat.disk_w_m2_um(g)[b], 1, 8e-3) << phase_deg;
    }
}

TEST(BodyHeat, TheDiskIsTheSumOfItsElements) {
    expect_disk_is_sum(BodyHeat({385, 95, 0.95}, kGrid));
    expect_disk_is_sum(BodyHeat(default_heat(BodyId::kMoon), kGrid));
}

// The Moon's ground is as hot as regolith is at noon, and keeps its heat after sunset: at 18:15 local time it is
// hotter than at 5:45, and it cools through the night.
TEST(BodyHeat, TheMoonsGroundKeepsItsHeat) {
    const BodyHeat heat(default_heat(BodyId::kMoon), kGrid);
    const auto kelvin = [&](float hour, float sine_latitude) {
        const float sent =
            heat.radiance({0, sine_latitude, (hour - 12) * static_cast<float>(kPi / 12)})[4] / 0.95f;
        double low = 10, high = 500;
        while (high - low > 1e-4)
            (planck_w_m2_sr_um(kGrid, 0.5 * (low + high))[4] < sent ? low : high) = 0.5 * (low + high);
        return low;
    };
    EXPECT_NEAR(kelvin(12, 0), 385, 5);  // Hayne et al. 2017, table A2
    EXPECT_NEAR(kelvin(0, 0), 101, 5);
    EXPECT_NEAR(kelvin(5.9f, 0), 95, 5);
    EXPECT_GT(kelvin(18.25f, 0), kelvin(5.75f, 0) + 20);
    EXPECT_GT(kelvin(12, 0.5f), kelvin(12, 0.9f) + 20);
    EXPECT_NEAR(kelvin(12, 0.5f), kelvin(12, -0.5f), 1e-3);
}

TEST(BodyHeat, ANightHotterThanNoonIsRefused) {
    EXPECT_THROW(validate(BodyHeatConfig{200, 201, 1}), KeyError);
    EXPECT_NO_THROW(validate(BodyHeatConfig{200, 200, 1}));
}

TEST(BodyHeat, RegolithIsTheMoonsAlone) {
    BodyHeatConfig mars = default_heat(BodyId::kMars), moon = default_heat(BodyId::kMoon);
    mars.model = BodyHeatConfig::Model::kRegolith;
    EXPECT_THROW(validate(mars), KeyError);
    EXPECT_NO_THROW(validate(moon));
    moon.emissivity = 0;  // would be infinitely hot
    EXPECT_THROW(validate(moon), KeyError);
}

TEST(BodyHeat, WithoutThermalBinsThereIsNone) {
    EXPECT_TRUE(BodyHeat(default_heat(BodyId::kMoon), SpectralGrid({0.4, 2.5})).none());
}

}  // namespace
}  // namespace hilcam
