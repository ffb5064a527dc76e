// Tests refraction against published tables and the closed form for exponential air.

#include "render/sky/air_refraction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "render/sky/standard_air.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kNoDistance_m = std::numeric_limits<double>::infinity();
constexpr double kBall_m = kEarthEquatorialRadius_m, kAirTop_m = 100e3;
constexpr double kSecond_rad = kPi / (180 * 3600);

AirRefraction standard_air(double um) {
    return {air_refractivity(um), standard_air_density, kBall_m, kAirTop_m};
}

// Returns the turn of a ray from outside with an impact height above the ground [rad].
double turn_past(const AirRefraction& air, double impact_height_m) {
    const Vec3d origin{4e8, kBall_m + impact_height_m, 0};
    const Vec3d out = air.beyond(origin, {-1, 0, 0}).dir;
    return std::atan2(-out.y, -out.x);
}

// Edlen's dispersion formula of 1966 (Metrologia 2, 71) is a fit to other measurements.
TEST(AirRefraction, RefractivityIsThatOfEdlen) {
    for (const double um : {0.40, 0.55, 0.80, 1.0}) {
        const double s2 = 1 / (um * um);
        const double edlen = 1e-8 * (8342.13 + 2406030 / (130 - s2) + 15997 / (38.9 - s2));
        EXPECT_NEAR(air_refractivity(um) / edlen, 1, 3e-4) << um;
    }
}

// Pulkovo's tables (Abalakin, Refraction tables of Pulkovo Observatory, 5th ed., 1985) for 15 deg C, 1013.25
// hPa, 0.59 um, at sea level: 1977.97" on the horizon; above it by a fit to them that is within 0.3". The
// closed form for points above the lowest is within 0.6 %.
TEST(AirRefraction, StarsAreLiftedAsInPulkovosTables) {
    const AirRefraction air = standard_air(0.59);
    const Vec3d origin{0, 0, kBall_m};
    for (const double height_deg : {0.0, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 45.0, 80.0}) {
        const double pulkovo_rad =
            kPi / 180 / 62.8093 /
            std::tan(kPi / 180 * (height_deg + 4.2206 / (height_deg + 15.1115 / (height_deg + 5.9431))));
        const double height_rad = kPi / 180 * height_deg;
        const Vec3d out = air.beyond(origin, {std::cos(height_rad), 0, std::sin(height_rad)}).dir;
        const double lifted_rad = height_rad - std::atan2(out.z, out.x);
        EXPECT_NEAR(lifted_rad / pulkovo_rad, 1, 0.008) << height_deg;
        if (height_deg == 0) {
            EXPECT_NEAR(lifted_rad / kSecond_rad, 1977.97, 4);
        }
    }
}

// Light that grazes the ground is bent twice as much as light that ends there.
TEST(AirRefraction, LightThatGrazesTheGroundTurnsTwiceTheRefractionOfTheHorizon) {
    const AirRefraction air = standard_air(0.59);
    EXPECT_NEAR(turn_past(air, air.apparent_height_m(0) + 1e-3) / kSecond_rad, 2 * 1977.97, 8);
    // Seen from afar the ground ends at n r; n by Edlen's formula at 0.59 um is 1.0002771.
    EXPECT_NEAR(air.apparent_height_m(0), 1767, 1);
    EXPECT_NEAR(air.max_turn_rad() / kSecond_rad, 2 * 1977.97, 8);
}

// Exponential air in closed form: n = exp(N exp(-(x - x_0) / H)), x = n r, turns a ray by
// 2 a N / H exp(x_0 / H) K_0(a / H). The density of such air is ln(n) / N at r = x / n; in thin air this is
// exp(-h / H) up to a relative error of N a / H.
TEST(AirRefraction, ExponentialAirTurnsLightByItsClosedForm) {
    static constexpr double kScale_m = 7000, kThin = 1e-6;
    const AirRefraction air(
        kThin, [](double height_m) { return std::exp(-height_m / kScale_m); }, kBall_m, kAirTop_m);
    for (const double height_m : {1000.0, 10e3, 20e3, 30e3, 45.5e3}) {
        const double a = kBall_m + height_m;
        // K_0(y) = sqrt(pi / 2 y) exp(-y) (1 - 1 / 8 y + ...)
        const double closed = 2 * a / kScale_m * kThin * std::exp(-height_m / kScale_m) *
                              std::sqrt(kPi * kScale_m / (2 * a)) * (1 - kScale_m / (8 * a));
        EXPECT_NEAR(turn_past(air, height_m) / closed, 1, 2e-3) << height_m;
    }
}

// A ray in the apparent direction leads to the star or point, and its light is between 0 and 1.
TEST(AirRefraction, FindsWhereAStarIsSeen) {
    const AirRefraction air = standard_air(0.55);
    for (const double radius_m : {kBall_m + 1.0, kBall_m + 12e3, kBall_m + 70e3, kBall_m + 420e3, 4.2e7, 4e8})
        for (int i = -4; i <= 40; ++i) {
            const double height_m = 2e3 * i;
            const Vec3d origin{0, 0, radius_m};
            const double horizon_rad =
                radius_m > kBall_m + height_m ? std::acos((kBall_m + height_m) / radius_m) : -0.02 * i;
            const Vec3d dir{std::cos(horizon_rad), 0, -std::sin(horizon_rad)};
            for (const double distance_m : {kNoDistance_m, 4e8}) {
                const AirRefraction::Seen seen = air.seen_at(origin, dir, distance_m);
                EXPECT_TRUE(seen.light > 0 && seen.light <= 1 + 1e-3) << radius_m << ' ' << height_m;
                if (seen.light == 1) continue;
                const AirRefraction::Line out = air.beyond(origin, seen.dir);
                if (std::isinf(distance_m)) {
                    EXPECT_NEAR(length(out.dir - dir), 0, 1e-10) << radius_m << ' ' << height_m;
                } else {
                    const Vec3d to_point = origin + distance_m * dir - out.origin_m;
                    EXPECT_NEAR(length(cross(to_point, out.dir)), 0, 0.1) << radius_m << ' ' << height_m;
                }
            }
        }
}

// The light curve of a star that isothermal air occults, by Baum & Code (Astron. J. 58, 108, 1953, eq. 8):
// where a share f of the light is left, the shadow is (1 / f - 2) + ln(1 / f - 1) scale heights further than
// where half is left. Their formula leaves out the horizontal focusing of light.
TEST(AirRefraction, SpreadsTheLightOfStarsAsBaumAndCodeHaveIt) {
    static constexpr double kScale_m = 7000;
    const AirRefraction air(
        1e-5, [](double height_m) { return std::exp(-height_m / kScale_m); }, kBall_m, kAirTop_m);
    constexpr double kAway_m = 1e8;
    // Where the line to the star meets the plane through the middle. The result is without horizontal
    // focusing.
    const auto share_at = [&](double place_m) {
        const double sine = place_m / kAway_m;
        const Vec3d dir{sine, 0, -std::sqrt(1 - sine * sine)};
        const AirRefraction::Seen seen = air.seen_at({0, 0, kAway_m}, dir, kNoDistance_m);
        return seen.light * sine / seen.dir.x;
    };
    double half_m = kBall_m, high_m = kBall_m + kAirTop_m;
    while (high_m - half_m > 0.1) {
        const double middle_m = 0.5 * (half_m + high_m);
        (share_at(middle_m) < 0.5 ? half_m : high_m) = middle_m;
    }
    for (const double scales : {-2.0, -1.0, 1.0, 2.0, 4.0}) {
        const double share = share_at(half_m + scales * kScale_m);
        EXPECT_NEAR(1 / share - 2 + std::log(1 / share - 1), -scales, 0.03) << share;
    }
}

// Positions, directions and lowest points of neighbouring rays have no step at the limb or at the top of the
// air.
TEST(AirRefraction, IsContinuous) {
    const AirRefraction air = standard_air(0.55);
    const double limb_m = kBall_m + air.apparent_height_m(0);
    struct Lines {
        AirRefraction::Line within, beyond;
    };
    const auto at = [&](double radius_m, double impact_m) {
        const double sine = impact_m / radius_m;
        const Vec3d origin{0, 0, radius_m}, dir{sine, 0, -std::sqrt(1 - sine * sine)};
        return Lines{air.within(origin, dir), air.beyond(origin, dir)};
    };
    for (const double radius_m : {kBall_m + 420e3, 4.2e7}) {
        const Lines on = at(radius_m, limb_m - 1e-5), past = at(radius_m, limb_m + 1e-5);
        EXPECT_NEAR(length(on.within.dir - past.within.dir), 0, 1e-5);
        EXPECT_NEAR(length(on.within.origin_m - past.within.origin_m) / radius_m, 0, 1e-5);
        const Lines inside = at(radius_m, kBall_m + kAirTop_m - 1),
                    outside = at(radius_m, kBall_m + kAirTop_m + 1);
        EXPECT_NEAR(length(inside.beyond.dir - outside.beyond.dir), 0,
                    2.4 / std::sqrt(radius_m * radius_m - std::pow(kBall_m + kAirTop_m, 2)));
    }
    for (const double impact_m : {0.9 * kBall_m, limb_m + 1, limb_m + 20e3}) {
        const Lines above = at(kBall_m + kAirTop_m + 1, impact_m),
                    below = at(kBall_m + kAirTop_m - 1, impact_m);
        EXPECT_NEAR(length(above.beyond.dir - below.beyond.dir), 0, 1e-5);
    }
    // Rays straight down, straight up and beside the air are not bent.
    for (const Vec3d dir : {Vec3d{0, 0, -1}, Vec3d{0, 0, 1}, Vec3d{1, 0, 0}}) {
        EXPECT_EQ(air.within({0, 0, kBall_m + 420e3}, dir).dir.x, dir.x);
        EXPECT_EQ(air.beyond({0, 0, kBall_m + 420e3}, dir).dir.z, dir.z);
    }
}

// A ray that meets the ground is as steep there as Snell's law says.
TEST(AirRefraction, MeetsTheGroundAsSteeplyAsSnellsLawSays) {
    const AirRefraction air = standard_air(0.55);
    const double n = 1 + air_refractivity(0.55), radius_m = kBall_m + 420e3;
    for (const double sine : {0.3, 0.7, 0.9, 0.93}) {
        const AirRefraction::Line ray = air.within({0, 0, radius_m}, {sine, 0, -std::sqrt(1 - sine * sine)});
        const double closest = length(cross(ray.origin_m, ray.dir));
        EXPECT_NEAR(closest / kBall_m, radius_m * sine / (n * kBall_m), 1e-12);
        EXPECT_NEAR(length(ray.origin_m), radius_m, 1e-6);
    }
}

}  // namespace
}  // namespace hilcam
