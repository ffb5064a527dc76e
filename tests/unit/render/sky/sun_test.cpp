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
