#include "render/sky/body_relief.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/sky/bodies.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kRadius_m = 1737.4e3;
constexpr int kWidth = 1440, kHeight = 720;

// A grid of height(longitude, latitude) [rad].
template <class F>
BodyRelief relief_of(const F& height_m) {
    std::vector<float> heights_m;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            heights_m.push_back(static_cast<float>(
                height_m(2 * kPi * ((x + 0.5) / kWidth - 0.5), kPi * (0.5 - (y + 0.5) / kHeight))));
    return {kRadius_m, kWidth, kHeight, std::move(heights_m)};
}
Vec3d dir_of(double lon_deg, double lat_deg) {
    const double lon = lon_deg * kDegree_rad, lat = lat_deg * kDegree_rad;
    return {std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat)};
}

TEST(BodyRelief, AnEvenHeightIsALargerSphere) {
    const BodyRelief relief = relief_of([](double, double) { return 5000; });
    const Figure larger{kRadius_m + 5000, kRadius_m + 5000};
    for (const double distance_m : {1.75e6, 4e6, 3.8e8, 1.5e11})
        for (const double off : {0.0, 0.3, 0.9, 0.9999, 1.0001}) {
            const Vec3d origin_m{distance_m, 0, 0};
            const double sine = std::min(0.999999, off * larger.equatorial_radius_m / distance_m);
            const Vec3d dir{-std::sqrt(1 - sine * sine), sine * std::cos(0.7), sine * std::sin(0.7)};
            const double expected = intersect_ellipsoid(larger, origin_m, dir);
            // A float holds a height to half a millimetre; grazing rays meet it over a longer way.
            const double found = relief.intersect(origin_m, dir);
            if (expected < 0)
                EXPECT_LT(found, 0) << distance_m << " " << off;
            else
                EXPECT_NEAR(found, expected, off > 0.99 ? 600 : 2) << distance_m << " " << off;
        }
}

TEST(BodyRelief, ASlopeTurnsTheNormal) {
    constexpr double kAmplitude_m = 2000, kWaves = 36;
    const BodyRelief relief =
        relief_of([](double lon, double) { return kAmplitude_m * std::sin(kWaves * lon); });
    const Vec3d normal = relief.normal(dir_of(0, 0), 0);
    // Differences over two spacings of 0.25 deg: sinc of the wave's 9 deg.
    const double slope = kAmplitude_m * kWaves / kRadius_m;
    EXPECT_NEAR(-normal.y / normal.x, slope, 0.01 * slope);
    EXPECT_NEAR(normal.z, 0, 1e-6);
    // Over ten waves nothing is left of it.
    EXPECT_NEAR(relief.normal(dir_of(0, 0), 10 * 2 * kPi * kRadius_m / kWaves).y, 0, 0.03 * slope);
}

// Land of 4 km from 10 to 30 deg east hides the Sun up to the angle at which its edge stands.
TEST(BodyRelief, AnEdgeStandsAsHighAsGeometrySays) {
    constexpr double kHigh_m = 4000;
    const BodyRelief relief = relief_of(
        [](double lon, double) { return lon > 10 * kDegree_rad && lon < 30 * kDegree_rad ? kHigh_m : 0; });
    for (const double lon_deg : {9.0, 8.0, 7.0}) {
        const Vec3d place_m = kRadius_m * dir_of(lon_deg, 0);
        // Bilinear: the ground is all up at the middle of the first cell, 10.125 deg.
        const double turn = (10.125 - lon_deg) * kDegree_rad;
        const double expected = std::atan2((kRadius_m + kHigh_m) * std::cos(turn) - kRadius_m,
                                           (kRadius_m + kHigh_m) * std::sin(turn));
        const Vec3d east{-std::sin(lon_deg * kDegree_rad), std::cos(lon_deg * kDegree_rad), 0};
        const double found = relief.horizon_rad(place_m, east, 0.5);
        // A step may pass the crest by its length; the angle falls by h / s^2 + 1 / 2R from there on.
        const double s_m = turn * kRadius_m, step_m = 0.5 * relief.spacing_m() + 0.04 * s_m;
        EXPECT_LE(found, expected + 1e-4) << lon_deg;
        EXPECT_GE(found, expected - step_m * (kHigh_m / (s_m * s_m) + 0.5 / kRadius_m)) << lon_deg;
        const auto sun = [&](double elevation) {
            return std::cos(elevation) * east + std::sin(elevation) * dir_of(lon_deg, 0);
        };
        constexpr double kDisk_rad = 0.00465;
        EXPECT_NEAR(relief.sun_share(place_m, sun(found), kDisk_rad), 0.5, 1e-6);
        EXPECT_EQ(relief.sun_share(place_m, sun(found + 1.01 * kDisk_rad), kDisk_rad), 1);
        EXPECT_EQ(relief.sun_share(place_m, sun(found - 1.01 * kDisk_rad), kDisk_rad), 0);
        // To the west there is nothing.
        EXPECT_LT(relief.horizon_rad(place_m, -east, 0.5), 0);
    }
}

// On the top of a mountain the Sun shines from below the level: the horizon dips by acos(R / (R + h)).
TEST(BodyRelief, FromAPeakTheHorizonDips) {
    const BodyRelief relief = relief_of([](double lon, double lat) {
        return 6000 * std::max(0.0, 1 - std::hypot(lon, lat) / (0.8 * kDegree_rad));
    });
    const Vec3d top_m = (kRadius_m + 6000) * dir_of(0, 0);
    const double dip = std::acos(kRadius_m / (kRadius_m + 6000));
    EXPECT_NEAR(relief.horizon_rad(top_m, {0, 1, 0}, 0.5), -dip, 0.02 * dip);
}

// A ray that grazes the sphere is stopped by a plateau at the limb, and only there.
TEST(BodyRelief, TheLimbHasItsProfile) {
    const BodyRelief relief = relief_of(
        [](double lon, double) { return std::abs(lon - 0.5 * kPi) < 5 * kDegree_rad ? 3000 : -1000; });
    const Vec3d far_m{3.8e8, 0, 0};
    const auto meets = [&](double sign, double height_m) {
        const Vec3d limb_m{0, sign * (kRadius_m + height_m), 0};
        // Along the tangent plane at the limb.
        const Vec3d origin_m = far_m + Vec3d{0, limb_m.y, 0};
        return relief.intersect(origin_m, {-1, 0, 0}) >= 0;
    };
    EXPECT_TRUE(meets(1, 2900));
    EXPECT_FALSE(meets(1, 3100));
    EXPECT_FALSE(meets(-1, -900));
    EXPECT_TRUE(meets(-1, -1100));
}

TEST(BodyRelief, TheSunsDiskSetsAsACircleDoes) {
    EXPECT_EQ(share_above(1), 1);
    EXPECT_NEAR(share_above(0), 0.5, 1e-12);
    EXPECT_EQ(share_above(-1), 0);
    EXPECT_NEAR(share_above(0.5) + share_above(-0.5), 1, 1e-12);
    // A segment of half angle 60 degrees: (pi / 3 - sin 60 cos 60) / pi.
    EXPECT_NEAR(share_above(-0.5), (kPi / 3 - std::sqrt(3) / 4) / kPi, 1e-12);
}

}  // namespace
}  // namespace hilcam
