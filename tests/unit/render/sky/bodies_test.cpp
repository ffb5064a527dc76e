#include <gtest/gtest.h>

#include "render/sky/bodies.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Equinox of 2026: March 20, 14:46 UTC (USNO, Earth's Seasons). The Sun then stands on the true equator; 20
// arcsec of aberration and the minute's rounding stay below 0.005 deg of declination.
TEST(Bodies, SunStandsOnTheEquatorAtTheEquinox) {
    const TimeTai time = parse_utc("2026-03-20T14:46:00Z");
    const Vec3d sun = normalized(earth_fixed_from_icrf(time, {}) * sun_from_earth_m(time));
    EXPECT_NEAR(std::asin(sun.z) / kDegree_rad, 0, 0.006);
    // Equation of time that day: -7.4 min (Astronomical Almanac); the Sun is over longitude -15 (14.767 - 12
    // - 0.123) deg.
    EXPECT_NEAR(std::atan2(sun.y, sun.x) / kDegree_rad, -39.65, 0.1);
}

TEST(Bodies, SunIsNearestInJanuary) {
    // Perihelion of 2026: January 3, 17:16 UTC, 0.98330 au (USNO).
    EXPECT_NEAR(length(sun_from_earth_m(parse_utc("2026-01-03T17:16:00Z"))) / kAstronomicalUnit_m, 0.98330,
                2e-5);
}

TEST(Bodies, GeostationaryPlaceIsWhereItShouldBe) {
    const Vec3d p = earth_fixed_position_m({90 * kDegree_rad, 0, 35'786'000});
    EXPECT_NEAR(p.y, 42'164'137, 1);
    EXPECT_NEAR(p.x, 0, 1e-6);
}

// Rays a metre at the limb to either side of it meet the ellipsoid and pass it, from the ground's next to the Moon
// and beyond, and about an axis that leads beside the middle.
TEST(Bodies, LimbIsWhereRaysTouch) {
    const Figure& figure = kFigures[index_of(BodyId::kEarth)];
    for (const double distance_m : {6.4e6, 6.8e6, 4.2e7, 3.8e8, 1.5e11})
        for (const Vec3d towards : {Vec3d{1, 0, 0}, Vec3d{0.3, 0.5, -0.8}, Vec3d{0, 0, 1}})
            for (int plane = 0; plane < 16; ++plane) {
                const Vec3d origin_m = distance_m * normalized(towards);
                const double off = 0.05 * figure.equatorial_radius_m / distance_m;
                const Vec3d axis = normalized(-1.0 * normalized(towards) + off * Vec3d{0.6, -0.64, 0.48});
                const Vec3d across = normalized(cross(axis, Vec3d{0.1, 1, 0.2}));
                const double phi = 2 * kPi * plane / 16;
                const Vec3d way = std::cos(phi) * across + std::sin(phi) * cross(axis, across);
                const double limb = limb_angle_rad(figure, origin_m, axis, way), metre = 1 / distance_m;
                const auto met = [&](double angle) {
                    return intersect_ellipsoid(figure, origin_m,
                                               std::cos(angle) * axis + std::sin(angle) * way) >= 0;
                };
                EXPECT_TRUE(met(limb - metre)) << distance_m << " " << plane;
                EXPECT_FALSE(met(limb + metre)) << distance_m << " " << plane;
            }
}

TEST(Bodies, EarthIsHitAtItsSurfaceAndMissedBesideIt) {
    constexpr double a = kEarthEquatorialRadius_m, b = a * (1 - kEarthFlattening);
    EXPECT_NEAR(intersect_earth({2 * a, 0, 0}, {-1, 0, 0}), a, 1e-6);
    EXPECT_NEAR(intersect_earth({0, 0, 3 * b}, {0, 0, -1}), 2 * b, 1e-6);
    EXPECT_LT(intersect_earth({2 * a, a + 1, 0}, {-1, 0, 0}), 0);
    EXPECT_LT(intersect_earth({2 * a, 0, 0}, {1, 0, 0}), 0);
    // From 10 au the limb is still sharp to centimetres.
    EXPECT_GT(intersect_earth({1.5e12, a - 1, 0}, {-1, 0, 0}), 0);
    EXPECT_LT(intersect_earth({1.5e12, a + 1, 0}, {-1, 0, 0}), 0);
}

// The Moon's near side: the Earth stays within 8.2 deg of its prime meridian and 6.9 deg of its equator
// (librations).
TEST(Bodies, TheMoonTurnsItsNearSideToTheEarth) {
    double max_longitude = 0, max_latitude = 0;
    for (int day = 0; day < 365; ++day) {
        const TimeTai time = parse_utc("2026-01-01T00:00:00Z") + day * 86'400'000'000'000LL;
        const Bodies bodies = bodies_at(time, {});
        const BodyState& moon = bodies[BodyId::kMoon];
        const Vec3d earth = normalized(moon.fixed_from_world * (bodies.earth().world_m - moon.world_m));
        max_longitude = std::max(max_longitude, std::abs(std::atan2(earth.y, earth.x)) / kDegree_rad);
        max_latitude = std::max(max_latitude, std::abs(std::asin(earth.z)) / kDegree_rad);
        // Perigee and apogee: 356,400 to 406,700 km.
        EXPECT_GT(length(moon.world_m), 356.3e6);
        EXPECT_LT(length(moon.world_m), 406.8e6);
    }
    EXPECT_GT(max_longitude, 5);
    EXPECT_LT(max_longitude, 8.3);
    EXPECT_GT(max_latitude, 6);
    EXPECT_LT(max_latitude, 7);
}

// Total eclipse of 2026-08-12: greatest at 17:45:51 UT, the Moon's shadow axis passes 0.898 Earth radii from
// the geocentre (gamma; NASA/GSFC eclipse catalogue, F. Espenak).
TEST(Bodies, TheMoonsShadowMissesTheEarthsMiddleByGamma) {
    const Bodies bodies = bodies_at(parse_utc("2026-08-12T17:45:51Z"), {});
    const Vec3d moon = bodies[BodyId::kMoon].world_m, axis = normalized(moon - bodies.sun_world_m);
    const Vec3d nearest = moon - dot(moon, axis) * axis;
    EXPECT_NEAR(length(nearest) / kEarthEquatorialRadius_m, 0.898, 0.02);
}

// Mars at opposition on 2027-02-19, 0.678 au away (JPL); Jupiter's opposition 2026-01-10, 4.232 au.
TEST(Bodies, PlanetsAreWhereTheAlmanacHasThem) {
    const auto distance_au = [](const char* utc, BodyId id) {
        return length(bodies_at(parse_utc(utc), {})[id].world_m) / kAstronomicalUnit_m;
    };
    EXPECT_NEAR(distance_au("2027-02-19T16:00:00Z", BodyId::kMars), 0.678, 0.001);
    EXPECT_NEAR(distance_au("2026-01-10T09:00:00Z", BodyId::kJupiter), 4.232, 0.002);
}

// Light time and aberration put the Sun 20.5 arcsec behind its geometric place along the ecliptic.
TEST(Bodies, TheSunStandsTwentyArcsecondsBack) {
    const TimeTai time = parse_utc("2026-03-20T14:46:00Z");
    const Vec3d geometric = normalized(sun_from_earth_m(time));
    const Vec3d apparent = normalized(bodies_at(time, {}).sun_world_m);
    EXPECT_NEAR(length(apparent - geometric) / kArcsecond_rad, 20.5, 0.4);
}

// The limb of a body that is seen in motion is its limb at rest, each direction of it aberrated (ERFA eraAb).
TEST(Bodies, InMotionTheLimbIsWhereAberrationPutsIt) {
    constexpr double kRadius_m = 6378137;
    for (const double distance_m : {6.4e6, 6.8e6, 4.2e7, 3.8e8})
        for (const Vec3d velocity_m_s : {Vec3d{7600, 0, 0}, Vec3d{0, 0, 7600}, Vec3d{3e5, -4e5, 2e5}}) {
            const Vec3d seen_m = seen_in_motion({0, 0, distance_m}, kRadius_m, velocity_m_s);
            const double sine = kRadius_m / distance_m, cosine = std::sqrt(1 - sine * sine);
            const double seen_cosine = std::sqrt(1 - kRadius_m * kRadius_m / dot(seen_m, seen_m));
            for (int i = 0; i < 12; ++i) {
                const double around = i * kPi / 6;
                const Vec3d limb{sine * std::cos(around), sine * std::sin(around), cosine};
                const Vec3d seen = aberrated(limb, velocity_m_s);
                // 1e-11 rad are 2 microarcseconds.
                const double angle = std::atan2(length(cross(seen, seen_m)), dot(seen, seen_m));
                EXPECT_NEAR(angle, std::acos(seen_cosine), 1e-11) << distance_m;
            }
        }
}

// A point is aberrated as a star; who rests sees what is there.
TEST(Bodies, APointInMotionIsAberrated) {
    const Vec3d to{1e9, 2e9, -5e8}, velocity{1000, -25000, 12000};
    EXPECT_LT(length(normalized(seen_in_motion(to, 0, velocity)) - aberrated(normalized(to), velocity)),
              1e-15);
    EXPECT_EQ(length(seen_in_motion(to, 1e6, {}) - to), 0);
}

}  // namespace
}  // namespace hilcam
