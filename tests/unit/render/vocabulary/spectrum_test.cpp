#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "render/vocabulary/check.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

TEST(Spectrum, BinAverageOfALineIsItsMiddle) {
    const SpectralGrid grid({0.4, 0.6, 0.9});
    const Spectrum s = grid.average({{0.4, 0.9}, {0, 1}, {}});
    EXPECT_NEAR(s[0], 0.2, 1e-6);
    EXPECT_NEAR(s[1], 0.7, 1e-6);
    EXPECT_EQ(s[2], 0);
}

TEST(Spectrum, ACurveThatDoesNotReachIsRefusedWithItsPlace) {
    const SpectralGrid grid({0.4, 0.9});
    const Curve shorter{{0.45, 0.9}, {1, 1}, "paint.yaml:3:14"};
    try {
        require_cover(shorter, grid, "reflectance");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what())
                      .find("paint.yaml:3:14: reflectance: the curve reaches from 0.450 to 0.900"),
                  std::string::npos)
            << error.what();
    }
    EXPECT_NO_THROW(require_cover(Curve::constant(0.3), grid, "reflectance"));
    EXPECT_NO_THROW(require_cover({{0.4, 0.9}, {1, 1}, {}}, grid, "reflectance"));
}

TEST(Spectrum, RefusesBadEdges) {
    EXPECT_THROW(SpectralGrid({0.5}), InputError);
    EXPECT_THROW(SpectralGrid({0.5, 0.4}), InputError);
    EXPECT_THROW(SpectralGrid({0.1, 0.4}), InputError);
}

// Exitance of a black body of 300 K in the bands of thermal cameras [W m^-2], by Simpson's rule in another
// program.
TEST(Planck, BandsOfABlackBodyAreThoseOfSimpsonsRule) {
    struct Band {
        double from_um, to_um, exitance_w_m2, per_k;
    };
    for (const Band& band : {Band{7.5, 13.5, 174.332, 2.7724},
                             {8, 14, 172.579, 2.6321},
                             {8, 12, 120.953, 1.9783},
                             {3, 5, 5.862, 0.2127}}) {
        const SpectralGrid grid({band.from_um, band.to_um});
        const auto exitance = [&](double k) {
            return kPi * grid.width_um(0) * static_cast<double>(planck_w_m2_sr_um(grid, k)[0]);
        };
        EXPECT_NEAR(exitance(300) / band.exitance_w_m2, 1, 1e-4) << band.from_um;
        EXPECT_NEAR((exitance(301) - exitance(299)) / 2 / band.per_k, 1, 3e-4) << band.from_um;
    }
}

// A narrow bin has the value at its wavelength, from cold to hot; nothing is emitted at 0 K, and all bins of a
// very hot body are numbers.
TEST(Planck, ANarrowBinHasTheValueAtItsWavelength) {
    for (const double kelvin : {3.0, 50.0, 300.0, 1500.0, 6000.0})
        for (const double um : {0.4, 2.0, 10.0, 19.0}) {
            const double expected = planck_w_m2_sr_um(um, kelvin);
            if (expected < 1e-30) continue;
            EXPECT_NEAR(static_cast<double>(
                            planck_w_m2_sr_um(SpectralGrid({um * (1 - 1e-4), um * (1 + 1e-4)}), kelvin)[0]) /
                            expected,
                        1, 1e-5)
                << um << " um " << kelvin << " K";
        }
    EXPECT_EQ(planck_w_m2_sr_um(SpectralGrid({8, 14}), 0)[0], 0);
    EXPECT_EQ(planck_w_m2_sr_um(SpectralGrid({0.4, 0.5}), 2.7)[0], 0);
}

TEST(SpectralGrid, ThermalBinsBeginAt2500Nanometres) {
    const SpectralGrid grid({0.4, 1, 2.5, 8, 14});
    EXPECT_EQ(grid.solar_bins(), 2);
    EXPECT_TRUE(grid.has_thermal());
    EXPECT_EQ(SpectralGrid({3, 5}).solar_bins(), 0);
    EXPECT_FALSE(SpectralGrid({0.4, 2.5}).has_thermal());
    EXPECT_THROW(SpectralGrid({2, 3}), InputError);
    EXPECT_THROW(SpectralGrid({8, 21}), InputError);
}

}  // namespace
}  // namespace hilcam
