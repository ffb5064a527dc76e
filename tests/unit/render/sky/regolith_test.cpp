#include "render/sky/regolith.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

double at_hour(const std::vector<double>& day_k, double hours_since_noon) {
    const double x = hours_since_noon / 24 * static_cast<double>(day_k.size());
    const auto i = static_cast<std::size_t>(x);
    const double t = x - static_cast<double>(i);
    return (1 - t) * day_k[i % day_k.size()] + t * day_k[(i + 1) % day_k.size()];
}

// Hayne et al. 2017, table A2, by Diviner: at the equator 385, 101 and 95 K at noon, at midnight, at least; 5 K each.
TEST(Regolith, TheMoonsEquatorIsAsDivinerSeesIt) {
    const std::vector<double> day_k = regolith_day_k({}, 0, 192);
    EXPECT_NEAR(day_k[0], 385, 5);
    EXPECT_NEAR(day_k[96], 101, 5);
    EXPECT_NEAR(*std::min_element(day_k.begin(), day_k.end()), 95, 5);
}

// Nights of Diviner's mean, as Hayne et al. 2017 plot them (figure A2): hours since noon, K.
TEST(Regolith, ItsNightsAreDiviners) {
    struct Night {
        double latitude_deg;
        std::array<std::array<double, 2>, 3> seen;
    };
    const Night nights[] = {{0, {{{8.483, 107.50}, {11.507, 100.38}, {16.49, 94.1}}}},
                            {30, {{{8.505, 105.08}, {10.502, 99.93}, {11.523, 98.01}}}},
                            {60, {{{8.502, 94.48}, {10.498, 89.88}, {11.509, 88.46}}}}};
    for (const Night& night : nights) {
        const std::vector<double> day_k = regolith_day_k({}, night.latitude_deg * kDegree_rad, 192);
        double sum = 0;
        for (const auto& [hour, kelvin] : night.seen) sum += std::pow(at_hour(day_k, hour) - kelvin, 2);
        EXPECT_LT(std::sqrt(sum / 3), 1) << night.latitude_deg;
    }
}

// Without a Sun the surface gives off what comes from below.
TEST(Regolith, ThePoleHasTheHeatFromBelow) {
    const Regolith ground;
    const std::vector<double> day_k = regolith_day_k(ground, kPi / 2, 24);
    const double even_k =
        std::pow(ground.inner_heat_w_m2 / (ground.emissivity * kStefanBoltzmann_w_m2_k4), 0.25);
    for (const double kelvin : day_k) EXPECT_NEAR(kelvin, even_k, 0.1);
}

// Over a day the surface gives off what it takes in, whatever the ground does between.
TEST(Regolith, ADaysHeatBalances) {
    const Regolith ground;
    constexpr int kCount = 4800;
    const std::vector<double> day_k = regolith_day_k(ground, 0.5, kCount);
    double in = 0, out = 0;
    for (int i = 0; i < kCount; ++i) {
        const double mu0 = std::cos(0.5) * std::cos(2 * kPi * i / kCount);
        if (mu0 > 0) in += (1 - ground.reflected(mu0)) * mu0 * ground.sun_w_m2 / kCount;
        out += ground.emissivity * kStefanBoltzmann_w_m2_k4 *
               std::pow(day_k[static_cast<std::size_t>(i)], 4) / kCount;
    }
    EXPECT_NEAR(out / (in + ground.inner_heat_w_m2), 1, 2e-3);
}

// Ten times the steps change day and night by less than 0.3 K, but around sunrise and sunset.
TEST(Regolith, StepsAreFineEnough) {
    const std::vector<double> coarse = regolith_day_k({}, 0.7, 96), fine = regolith_day_k({}, 0.7, 4800);
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        const bool sun_sets = i >= 20 && i <= 28, sun_rises = i >= 68 && i <= 76;
        if (sun_sets || sun_rises) continue;
        EXPECT_NEAR(coarse[i], fine[i * 50], 0.3) << i;
    }
}

// Ground that takes up nothing is without seasons of its day: an insulator follows the Sun.
TEST(Regolith, AnInsulatorFollowsTheSun) {
    Regolith ground;
    ground.surface_conductivity_w_m_k = ground.deep_conductivity_w_m_k = 1e-7;
    ground.radiative = 0;
    const std::vector<double> day_k = regolith_day_k(ground, 0, 24);
    for (const int hour : {0, 1, 2, 3, 4}) {
        const double mu0 = std::cos(hour * kPi / 12);
        const double even_k = std::pow((1 - ground.reflected(mu0)) * mu0 * ground.sun_w_m2 /
                                           (ground.emissivity * kStefanBoltzmann_w_m2_k4),
                                       0.25);
        EXPECT_NEAR(day_k[static_cast<std::size_t>(hour)], even_k, 0.01 * even_k) << hour;
    }
}

}  // namespace
}  // namespace hilcam
