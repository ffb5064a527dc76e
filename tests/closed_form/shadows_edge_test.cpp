// The edge of a shadow in the visibility buffer's picture against the share of the Sun's disk that stands past it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

class ShadowsEdge : public testing::TestWithParam<const char*> {};
// A plate a quarter of a metre above a floor, the Sun at 45 degrees: along the shadow's edge the floor has the light
// of that part of the disk which stands past the plate. Seen by sixteen samples with a ray each to the Sun's
// middle it would be none or all.
TEST_P(ShadowsEdge, IsAsWideAsTheSun) {
    constexpr double kAbove_m = 0.25, kPixel_m = 1.25e-3, kSunRadius_rad = 6.957e8 / kAstronomicalUnit_m;
    Stage s;
    s.quality.path_model = GetParam();
    s.quality.visibility = "buffer";
    s.quality.sun_disk = false;
    s.quality.rays_across = 0;
    s.geometry.focal_length_px = 4 / kPixel_m;
    s.sun({1, 0, -1});
    s.add(plate(lambert(0.5), s.grid), {0, 0, 4});
    s.add(plate(lambert(0.5), s.grid), {1 + kAbove_m, 0, 4 - kAbove_m});
    s.render();
    const double lit = 0.5 / kPi * static_cast<double>(kSun_w_m2_um) * std::sqrt(0.5);
    // The share of a disk of radius 1 past an edge that is so far from its middle.
    const auto past = [](double d) {
        d = std::clamp(d, -1.0, 1.0);
        return 0.5 + (std::asin(d) + d * std::sqrt(1 - d * d)) / kPi;
    };
    const int middle = s.radiance.width() / 2;
    for (int x = 0; x < s.radiance.width(); ++x) {
        double mean = 0, expected = 0;
        for (int y = middle - 8; y < middle + 8; ++y)
            mean += static_cast<double>(s.radiance.row(y, 0)[static_cast<std::size_t>(x)]) / 16;
        // A way along the floor turns the direction to the plate's edge by half of it over the height.
        for (int i = 0; i < 8; ++i) {
            const double off_m = -kPixel_m * (x - middle + (i + 0.5) / 8);
            expected += past(off_m / (2 * kAbove_m) / kSunRadius_rad) / 8;
        }
        EXPECT_NEAR(mean / lit, expected, 0.07) << x;
    }
}
INSTANTIATE_TEST_SUITE_P(ByModel, ShadowsEdge, testing::Values("direct", "cached"));

}  // namespace
}  // namespace hilcam
