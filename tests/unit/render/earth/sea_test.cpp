// The sea's glint against facets that are thrown at random, and against Cox & Munk's slopes.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "render/earth/sea.h"
#include "render/vocabulary/units.h"
#include "render/vocabulary/vec.h"

namespace hilcam {
namespace {

const SpectralGrid kGrid({0.45, 0.55, 0.65});

// Fresnel's law for n = 1.34: 0.0211 straight down ((0.34 / 2.34)^2), 1 along the surface.
TEST(Sea, MirrorsByFresnelsLaw) {
    EXPECT_NEAR(water_fresnel(1), 0.34 * 0.34 / (2.34 * 2.34), 1e-6);
    EXPECT_NEAR(water_fresnel(0), 1, 1e-6);
    // Brewster's angle, atan 1.34: half of the perpendicular part, ((n^2 - 1) / (n^2 + 1))^2 / 2.
    const double n2 = 1.34 * 1.34, s = (n2 - 1) / (n2 + 1);
    EXPECT_NEAR(water_fresnel(static_cast<float>(std::cos(std::atan(1.34)))), 0.5 * s * s, 1e-6);
}

// Radiance that leaves into a cone, from facets of Gaussian slopes, each a mirror: 4 standard errors of 400000 facets
// and 1 % of what Smith's shadowing takes at these angles.
TEST(Sea, GlintIsTheLightOfItsFacets) {
    for (const double wind : {2.0, 7.0, 14.0}) {
        const Sea sea(wind, kGrid);
        const double sigma = std::sqrt(0.5 * (0.003 + 0.00512 * wind));
        const double zenith = 30 * kDegree_rad;
        const Vec3d sun{std::sin(zenith), 0, std::cos(zenith)}, axis{-std::sin(zenith), 0, std::cos(zenith)};
        const double cone = std::cos(8 * kDegree_rad);
        std::mt19937_64 random(5);
        std::normal_distribution<double> slope(0, sigma);
        constexpr int kFacets = 400000;
        double sum = 0, squares = 0;
        for (int i = 0; i < kFacets; ++i) {
            const Vec3d n = normalized(Vec3d{-slope(random), -slope(random), 1});
            const double incidence = dot(n, sun);
            if (incidence <= 0) continue;
            if (dot(2 * incidence * n - sun, axis) < cone) continue;
            const double light =
                incidence / n.z * static_cast<double>(water_fresnel(static_cast<float>(incidence)));
            sum += light, squares += light * light;
        }
        const double mean = sum / kFacets, error = std::sqrt(squares) / kFacets;
        double integral = 0;
        constexpr int kRings = 40, kSpokes = 80;
        const Vec3d side{std::cos(zenith), 0, std::sin(zenith)}, up{0, 1, 0};
        for (int i = 0; i < kRings; ++i)
            for (int j = 0; j < kSpokes; ++j) {
                const double c = 1 - (i + 0.5) / kRings * (1 - cone), s = std::sqrt(1 - c * c);
                const double phi = 2 * kPi * j / kSpokes;
                const Vec3d dir = c * axis + s * std::cos(phi) * side + s * std::sin(phi) * up;
                integral += dir.z * static_cast<double>(sea.glint_sr(static_cast<float>(sun.z),
                                                                     static_cast<float>(dir.z),
                                                                     static_cast<float>(dot(dir, sun))));
            }
        integral *= 2 * kPi * (1 - cone) / (kRings * kSpokes) / (1 - sea.foam_share());
        EXPECT_NEAR(integral, mean, 4 * error + 0.01 * mean) << wind;
    }
}

// Cox & Munk 1954: with the Sun overhead the glint's slopes have a variance of 0.003 + 0.00512 U, within 0.004; and it is brightest
// where a level sea mirrors the Sun.
TEST(Sea, GlintIsAsWideAsCoxAndMunkMeasured) {
    for (const double wind : {1.0, 5.0, 10.0, 13.0}) {
        const Sea sea(wind, kGrid);
        double weight = 0, second = 0;
        for (double slope = 0.001; slope < 1; slope += 0.002) {
            const double beta = std::atan(slope), view = 2 * beta, mu = std::cos(view);
            if (mu < 0.1) break;
            const double c4 = std::pow(std::cos(beta), 4);
            const double density =
                4 * mu * c4 *
                static_cast<double>(sea.glint_sr(1, static_cast<float>(mu), static_cast<float>(mu))) /
                static_cast<double>(water_fresnel(static_cast<float>(std::cos(beta))));
            weight += density * slope, second += density * slope * slope * slope;
        }
        EXPECT_NEAR(second / weight, 0.003 + 0.00512 * wind, 0.004) << wind;
    }
    // Sun at 40 degrees: over nadir to 80 degrees in its plane, the brightest is within 3 degrees of 40 for a light wind.
    const Sea calm(1, kGrid);
    const double zenith = 40 * kDegree_rad;
    double best = 0, at = 0;
    for (double view = 0; view < 80; view += 0.25) {
        const double v = view * kDegree_rad;
        const double light = static_cast<double>(calm.glint_sr(static_cast<float>(std::cos(zenith)),
                                                               static_cast<float>(std::cos(v)),
                                                               static_cast<float>(std::cos(zenith + v))));
        if (light > best) best = light, at = view;
    }
    EXPECT_NEAR(at, 40, 3);
}

TEST(Sea, FoamGrowsWithTheWind) {
    EXPECT_EQ(Sea(0, kGrid).foam_share(), 0);
    EXPECT_NEAR(Sea(10, kGrid).foam_share(), 2.95e-6 * std::pow(10, 3.52), 1e-9);
}

}  // namespace
}  // namespace hilcam
