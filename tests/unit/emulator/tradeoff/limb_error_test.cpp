#include "emulator/tradeoff/limb_error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hilcam {
namespace {

constexpr Mat3d kUnturned{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

ImageGeometry geometry_200() {
    ImageGeometry g;
    g.width_px = g.height_px = 200;
    g.focal_length_px = 1000;
    return g;
}

// An evenly bright disk about (100, 100) whose edge is blurred by a Gaussian of 3 px.
ElectronImage disk(double radius_px, double disk_e, double sky_e) {
    ElectronImage image(200, 200);
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 200; ++x) {
            const double r = std::hypot(x + 0.5 - 100, y + 0.5 - 100);
            image.row(y)[static_cast<std::size_t>(x)] = static_cast<float>(
                sky_e + (disk_e - sky_e) * 0.5 * std::erfc((r - radius_px) / (3 * std::sqrt(2.0))));
        }
    return image;
}

std::vector<LimbPlace> sphere_places(double radius_m, double distance_m) {
    return limb_places({{0, 0, distance_m}, kUnturned, {}}, {radius_m, radius_m}, {}, geometry_200());
}

TEST(LimbPlaces, OfASphereAreACircleOfTheTangentCone) {
    // Half angle asin(a / d), so tan = a / sqrt(d^2 - a^2).
    constexpr double kRadius_m = 1e6, kDistance_m = 2e7;
    const double expected_px =
        1000 * kRadius_m / std::sqrt(kDistance_m * kDistance_m - kRadius_m * kRadius_m);
    const auto places = sphere_places(kRadius_m, kDistance_m);
    ASSERT_EQ(places.size(), 512u);
    for (const LimbPlace& p : places) {
        const Vec2d from_middle{p.position_px.x - 100, p.position_px.y - 100};
        const double r = std::hypot(from_middle.x, from_middle.y);
        EXPECT_NEAR(r, expected_px, 1e-9);
        // Outwards along the radius; the tangent's chord of 1e-6 rad turns it by half of that.
        EXPECT_NEAR(p.sky_dir.x, from_middle.x / r, 1e-6);
        EXPECT_NEAR(p.sky_dir.y, from_middle.y / r, 1e-6);
    }
}

TEST(LimbPlaces, OfAnEllipsoidPartRaysThatHitFromRaysThatMiss) {
    const BodyState body{{3e5, -2e5, 2e7}, {{0.6, 0, 0.8}, {0, 1, 0}, {-0.8, 0, 0.6}}, {}};
    const Figure figure{1e6, 0.8e6};
    const ImageGeometry g = geometry_200();
    const auto places = limb_places(body, figure, {}, g);
    ASSERT_GT(places.size(), 100u);
    for (const LimbPlace& p : places)
        for (const double step_px : {-1e-3, 1e-3}) {
            const Vec3d dir =
                body.fixed_from_world * g.direction_camera(p.position_px.x + step_px * p.sky_dir.x,
                                                           p.position_px.y + step_px * p.sky_dir.y);
            EXPECT_EQ(intersect_ellipsoid(figure, body.fixed_from_world * (-1.0 * body.world_m), dir) > 0,
                      step_px < 0);
        }
}

TEST(LimbPlaces, AreNoneOutOfViewOrInsideTheBody) {
    EXPECT_TRUE(sphere_places(1e6, -2e7).empty());  // behind
    EXPECT_TRUE(sphere_places(1e6, 5e5).empty());   // inside
    EXPECT_TRUE(sphere_places(1e7, 2e7).empty());   // wider than the picture
}

TEST(LimbError, IsTheShiftOfTheEdge) {
    const auto places = sphere_places(1e6, 2e7);  // 50.06 px
    const ElectronImage reference = disk(50, 8000, 100);
    // Linear interpolation between pixels 1 px apart (1.4 along a diagonal) is off by f''/8 at most, here
    // 1/4 px from the middle of the edge 0.0012 of its height or 0.01 px; the mean of many places is better.
    for (const double shift_px : {0.3, -0.7, 2.0}) {
        const auto error = limb_error(disk(50 + shift_px, 8000, 100), reference, places, {}, 10);
        ASSERT_TRUE(error);
        EXPECT_NEAR(error->rms_px, std::abs(shift_px), 0.02) << shift_px;
        EXPECT_EQ(error->places, 512);
    }
    EXPECT_EQ(limb_error(reference, reference, places, {}, 10)->rms_px, 0);
}

TEST(LimbError, OfALostLimbIsTheReach) {
    const auto places = sphere_places(1e6, 2e7);
    const auto error = limb_error(disk(-50, 8000, 100), disk(50, 8000, 100), places, {}, 10);
    // From the middle of the profile to its end.
    EXPECT_NEAR(error->rms_px, kLimbReach_px, 0.1);
}

TEST(LimbError, CountsNoUnlitLimb) {
    const auto places = sphere_places(1e6, 2e7);
    const ElectronImage dark = disk(50, 105, 100);
    EXPECT_FALSE(limb_error(dark, dark, places, {}, 10));
}

}  // namespace
}  // namespace hilcam
