#include <gtest/gtest.h>

#include <string>

#include "render/vocabulary/check.h"
#include "render/vocabulary/spectrum.h"

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

}  // namespace
}  // namespace hilcam
