#include <gtest/gtest.h>

#include "render/sky/sun.h"

namespace hilcam {
namespace {

// ASTM G173-03's extraterrestrial column: its integral from 0.28 to 2.5 um is 1314.88 W m^-2 by the
// trapezoidal rule on the full table; single values from the table itself.
TEST(Sun, SpectrumIsThatOfTheTable) {
    std::vector<double> edges;
    for (int i = 0; i <= 8; ++i) edges.push_back(0.28 + i * 2.22 / 8);
    const SpectralGrid grid(edges);
    const Spectrum s = solar_irradiance_1au_w_m2_um(grid);
    double total = 0;
    for (int b = 0; b < 8; ++b) total += static_cast<double>(s[b]) * grid.width_um(b);
    EXPECT_NEAR(total, 1314.88, 0.5);
    EXPECT_NEAR(solar_irradiance_1au_w_m2_um(SpectralGrid({0.55, 0.555}))[0], 1870.2, 0.1);
    EXPECT_THROW(solar_irradiance_1au_w_m2_um(SpectralGrid({0.25, 0.3})), InputError);
}

// ASTM E490-00a between the wavelengths that are stored [um, W m^-2 um^-1]; and 39.555 W m^-2 from 2.5 to 5 um, by
// the trapezoidal rule on its own steps.
TEST(Sun, InTheInfraredItIsThatOfE490) {
    constexpr double kTable[][2] = {{2.56, 46.72}, {3.04, 24.65}, {3.74, 11.08},  {4.20, 7.153},
                                    {4.70, 4.514}, {5.75, 2.054}, {8.75, 0.4044}, {9.75, 0.2661}};
    for (const auto& [um, irradiance] : kTable)
        EXPECT_NEAR(solar_irradiance_1au_w_m2_um(SpectralGrid({um - 0.001, um + 0.001}))[0] / irradiance, 1,
                    0.012)
            << um;
    const SpectralGrid whole({1.5, 2.5, 5});
    EXPECT_NEAR(2.5 * static_cast<double>(solar_irradiance_1au_w_m2_um(whole)[1]), 39.555, 0.1);
}

// The mean over the disk is 1 by definition; at 0.541 um the limb (mu = 0.2) has 0.4738 of the middle's
// radiance: Neckel & Labs 1994, 0.26073 + 1.27428 mu - 1.30352 mu^2 + ....
TEST(Sun, LimbDarkeningKeepsTheMeanAndFollowsTheTable) {
    const SpectralGrid grid({0.4, 0.5, 0.541, 0.5425, 0.9});
    const SunDisk disk(grid, true);
    for (int b = 0; b < grid.size(); ++b) {
        double mean = 0;
        constexpr int kSteps = 2000;
        for (int i = 0; i < kSteps; ++i) {
            const double mu = (i + 0.5) / kSteps;
            mean += 2 * mu * static_cast<double>(disk.relative_radiance(static_cast<float>(mu))[b]) / kSteps;
        }
        EXPECT_NEAR(mean, 1, 1e-4);
    }
    EXPECT_NEAR(disk.relative_radiance(0.2f)[2] / disk.relative_radiance(1)[2], 0.4737, 2e-3);
    EXPECT_EQ(SunDisk(grid, false).relative_radiance(0.3f)[0], 1);
}

}  // namespace
}  // namespace hilcam
