// Tests the angular law of land against the integrals of the kernels in MODIS' albedo product.

#include "render/earth/land_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Calls use(mu, cosine of the azimuth, weight) for directions to a viewer over the hemisphere,
// cosine-weighted.
template <class Use>
void over_half_sphere(const Use& use) {
    constexpr int kRings = 200, kSpokes = 100;
    for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < kSpokes; ++j)
            use(static_cast<float>(std::sqrt((i + 0.5) / kRings)),
                static_cast<float>(std::cos(kPi * (j + 0.5) / kSpokes)), 1.0 / (kRings * kSpokes));
}

// Black-sky integrals by the Sun's zenith angle z (Lucht, Schaaf & Strahler 2000, table 1):
//     -0.007574 - 0.070987 z^2 + 0.307588 z^3   and   -1.284909 - 0.166314 z^2 + 0.041840 z^3
// These fits are good to some 0.02.
TEST(LandShape, KernelsHaveTheIntegralsOfModis) {
    for (const double z : {0.0, 0.3, 0.6, 0.9, 1.1}) {
        const auto mu0 = static_cast<float>(std::cos(z));
        double volume = 0, geometry = 0;
        over_half_sphere([&](float mu, float cos_azimuth, double weight) {
            const LandKernels k = land_kernels(mu0, mu, cos_azimuth);
            volume += weight * static_cast<double>(k.volume),
                geometry += weight * static_cast<double>(k.geometry);
        });
        EXPECT_NEAR(volume, -0.007574 - 0.070987 * z * z + 0.307588 * z * z * z, 0.02) << z;
        EXPECT_NEAR(geometry, -1.284909 - 0.166314 * z * z + 0.041840 * z * z * z, 0.03) << z;
    }
}

// With Sun and viewer in the zenith both kernels are zero (Wanner, Li & Strahler 1995). In the hot spot at 45
// degrees K_vol is pi / (4 cos) - pi / 4 and K_geo is 1 / cos^2 - 1 / cos.
TEST(LandShape, KernelsAreThoseOfTheirFormulasWhereThoseAreShort) {
    EXPECT_NEAR(land_kernels(1, 1, 1).volume, 0, 1e-5);
    EXPECT_NEAR(land_kernels(1, 1, 1).geometry, 0, 1e-3);
    const auto mu = static_cast<float>(std::cos(0.25 * kPi));
    EXPECT_NEAR(land_kernels(mu, mu, 1).volume, 0.25 * kPi / static_cast<double>(mu) - 0.25 * kPi, 1e-3);
    EXPECT_NEAR(land_kernels(mu, mu, 1).geometry, 1 / (mu * mu) - 1 / mu, 2e-3);
}

// Under a uniform sky the angular law does not change the albedo.
TEST(LandShape, KeepsTheAlbedo) {
    const SpectralGrid grid({0.40, 0.48, 0.58, 0.69, 0.90});
    const LandShape shape(grid);
    std::array<double, 4> sum{};
    constexpr int kSuns = 40;
    for (int i = 0; i < kSuns; ++i) {
        const auto mu0 = static_cast<float>(std::sqrt((i + 0.5) / kSuns));
        over_half_sphere([&](float mu, float cos_azimuth, double weight) {
            const float sines = std::sqrt((1 - mu0 * mu0) * (1 - mu * mu));
            const Spectrum s = shape.of(mu0, mu, mu0 * mu + sines * cos_azimuth);
            for (std::size_t b = 0; b < sum.size(); ++b)
                sum[b] += weight / kSuns * static_cast<double>(s.bin[b]);
        });
    }
    for (const double mean : sum) EXPECT_NEAR(mean, 1, 0.01);
}

}  // namespace
}  // namespace hilcam
