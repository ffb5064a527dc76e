#include <gtest/gtest.h>

#include <random>
#include <string>

#include "render/scene/earth_rays.h"
#include "render/sky/bodies.h"
#include "render/sky/body_light.h"
#include "render/sky/sun.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

TEST(Time, UtcTextComesBackAndLeapSecondsCount) {
    EXPECT_EQ(format_utc(parse_utc("2026-03-20T14:46:00.250Z")), "2026-03-20T14:46:00.250Z");
    // TAI - UTC was 10 s in 1972 and is 37 s since 2017 (IERS Bulletin C).
    EXPECT_EQ(parse_utc("1972-01-01T00:00:00Z").ns, (730 * 86400 + 10) * 1'000'000'000LL);
    EXPECT_EQ(parse_utc("2017-01-01T00:00:00Z") - parse_utc("2016-12-31T23:59:59Z"), 2'000'000'000LL);
}

TEST(Time, RefusesWhatIsNoTime) {
    for (const char* text : {"", "yesterday", "2026-13-01T00:00:00Z", "2026-01-01", "2026-01-01T00:00:nanZ",
                             "1066-10-14T09:00:00Z"})
        EXPECT_THROW(parse_utc(text), InputError) << text;
}

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
                const double off = 0.2 * figure.equatorial_radius_m / distance_m;
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

TEST(Spectrum, BinAverageOfALineIsItsMiddle) {
    const SpectralGrid grid({0.4, 0.6, 0.9});
    const Spectrum s = grid.average({{0.4, 0.9}, {0, 1}, {}});
    EXPECT_NEAR(s[0], 0.2, 1e-6);
    EXPECT_NEAR(s[1], 0.7, 1e-6);
    EXPECT_EQ(s[2], 0);
}

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

// Point and disk of a body have the same light, whatever the law: the sum of its radiance over the disk
// against disk_albedo. The Moon at 40 degrees: V = -12.73 + 0.026 x 40 + 4e-9 x 40^4 (Krisciunas & Schaefer
// 1991).
TEST(BodyLight, DiskSumsUpToTheMagnitude) {
    const SpectralGrid grid({0.545, 0.555});
    for (const BodyId id : {BodyId::kMoon, BodyId::kMars, BodyId::kJupiter}) {
        const BodyLook look(id, default_body(id), grid);
        for (const double phase : {0.0, 40 * kDegree_rad}) {
            const Vec3d sun{std::sin(phase), 0, std::cos(phase)};
            double sum = 0;
            constexpr int kGrid = 1000;
            for (int i = 0; i < kGrid; ++i)
                for (int j = 0; j < kGrid; ++j) {
                    const double x = 2 * (i + 0.5) / kGrid - 1, y = 2 * (j + 0.5) / kGrid - 1;
                    if (x * x + y * y >= 1) continue;
                    const Vec3d n{x, y, std::sqrt(1 - x * x - y * y)};
                    sum += static_cast<double>(look.reflectance_sr(static_cast<float>(dot(n, sun)),
                                                                   static_cast<float>(n.z),
                                                                   static_cast<float>(sun.z))[0]) *
                           4 / (kGrid * kGrid);
                }
            EXPECT_NEAR(sum / static_cast<double>(look.disk_albedo(phase)[0]), 1, 2e-3)
                << static_cast<int>(id);
            const double ratio = kFigures[index_of(id)].equatorial_radius_m / kAstronomicalUnit_m;
            EXPECT_NEAR(-2.5 * std::log10(sum * ratio * ratio) - 26.76, magnitude_v_1au(id, phase), 0.005);
        }
    }
    EXPECT_NEAR(magnitude_v_1au(BodyId::kMoon, 0) + 5 * std::log10(384400e3 / kAstronomicalUnit_m), -12.73,
                0.01);
}

// The vector form says what the scalar one says, from low orbit to the Moon, limb included.
TEST(EarthRays, AgreeWithTheSingleRay) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    int met = 0, missed = 0;
    for (const double height_m : {300e3, 36e6, 384e6}) {
        const Vec3d camera = (kEarthEquatorialRadius_m + height_m) * normalized(Vec3d{1, 0.5, 0.4});
        const Vec3d sun = normalized(Vec3d{0.3, -1, 0.2});
        const double size =
            1.2 * kEarthEquatorialRadius_m / length(camera) / 16;  // a little more than the disk
        const Vec3d corner = normalized(-camera), right = size * normalized(cross(corner, Vec3d{0, 0, 1}));
        const Vec3d down = cross(corner, right);
        const EarthRays rays(kFigures[index_of(BodyId::kEarth)], camera, sun, corner, right, down);
        for (int block = 0; block < 100; ++block) {
            EarthRays::Floats x, y, cosine;
            for (std::size_t i = 0; i < EarthRays::kCount; ++i)
                x[i] = static_cast<float>(16 * uniform(random)),
                y[i] = static_cast<float>(16 * uniform(random));
            rays.sun_cosines(x, y, cosine);
            for (std::size_t i = 0; i < EarthRays::kCount; ++i) {
                const Vec3d dir =
                    corner + static_cast<double>(x[i]) * right + static_cast<double>(y[i]) * down;
                const double distance = intersect_earth(camera, dir);
                ASSERT_EQ(distance < 0, cosine[i] == EarthRays::kMiss);
                ++(distance < 0 ? missed : met);
                if (distance < 0) continue;
                ASSERT_NEAR(dot(earth_normal(camera + distance * dir), sun), cosine[i], 1e-6);
            }
        }
    }
    EXPECT_GT(met, 1000);
    EXPECT_GT(missed, 500);
}

}  // namespace
}  // namespace hilcam
