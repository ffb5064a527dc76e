// The edge of a shadow in the visibility buffer's picture against the share of the Sun's disk that stands past it.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

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

// The camera sees metal in the Sun's highlight. Two plates just above the metal leave a slit, and the sunlight that passes it is a
// strip a third of a pixel wide, slightly oblique to the columns of pixels. All rows of pixels have about the same light; a single
// ray from the middle of each pixel leaves rows dark.
TEST(ShadowsEdge, AStripOfSunlightThinnerThanAPixelIsNotDashed) {
    constexpr float kPixel_m = 1.25e-3f, kAbove_m = 0.02f, kSlit_m = 0.3f * kPixel_m, kLeans = 0.08f;
    Stage s;
    s.quality.path_model = "direct", s.quality.visibility = "buffer", s.quality.rays_across = 0;
    s.quality.sun_disk = false;
    s.geometry.focal_length_px = 4 / static_cast<double>(kPixel_m);
    const Vec3f sun = normalized(Vec3f{1, 0, -1}), across = normalized(Vec3f{1, 0, 1});
    s.sun(to_double(sun));
    MaterialConfig metal = lambert(0.9);
    metal.model = kModel<brdf::Metal>;
    metal.roughness = 0.4;
    const Vec3f along =
        normalized(Vec3f{0.9239f, 0, 0.3827f});  // of the metal, half-way between camera and Sun
    const auto corners = [](const Vec3f& middle, Vec3f to, float from, float until, float leans) {
        std::vector<Vec3f> out;
        for (const Vec2f at : {Vec2f{from, -1}, Vec2f{until, -1}, Vec2f{until, 1}, Vec2f{from, 1}})
            out.push_back(middle + (at.x + leans * 0.03f * at.y) * to + Vec3f{0, 0.03f * at.y, 0});
        return out;
    };
    const std::vector<std::array<std::uint32_t, 3>> both{{0, 1, 2}, {0, 2, 3}};
    s.add(object_of(corners({}, along, -0.03f, 0.03f, 0), both, metal, s.grid), {0, 0, 4}, {});
    for (const Vec2f part : {Vec2f{-0.012f, -kSlit_m / 2}, Vec2f{kSlit_m / 2, 0.03f}})
        s.add(object_of(corners(kAbove_m * sun, across, part.x, part.y, kLeans), both, lambert(0), s.grid),
              {0, 0, 4}, {});
    s.render();
    const int middle = s.radiance.width() / 2;
    std::vector<double> rows;
    for (int y = middle - 10; y < middle + 10; ++y) {
        double sum = 0;
        for (int x = middle - 4; x < middle + 4; ++x)
            sum += static_cast<double>(s.radiance.row(y, 0)[static_cast<std::size_t>(x)]);
        rows.push_back(sum);
    }
    const auto [least, most] = std::minmax_element(rows.begin(), rows.end());
    EXPECT_GT(*least, 0.5 * *most);
    EXPECT_GT(*most, 0);
}

}  // namespace
}  // namespace hilcam
