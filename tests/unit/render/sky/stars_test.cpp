// Stars: light, places, and which of them a field holds.

#include "render/sky/stars.h"

#include <erfa.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "render/sky/bodies.h"
#include "render/sky/star_sky.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kMas_rad = 1e-3 * kArcsecond_rad;

CatalogueStar sirius() {
    CatalogueStar star;
    star.hip = 32349, star.hd = 48915;
    star.right_ascension_rad = 101.28854 * kDegree_rad, star.declination_rad = -16.71314 * kDegree_rad;
    star.pm_ra_cosdec_rad_yr = -546.01 * kMas_rad, star.pm_dec_rad_yr = -1223.07 * kMas_rad;
    star.parallax_rad = 379.21 * kMas_rad;
    star.magnitude_v = -1.44;
    return star;
}

StarCatalogue only(const CatalogueStar& star) { return {{star}}; }

TEST(Stars, ProperMotionMovesSirius) {
    // Sirius: -546.01, -1223.07 mas/yr (Hipparcos); J1991.25 place to J2000.0 (SIMBAD: 101.287155
    // -16.716116).
    const StarCatalogue catalogue = only(sirius());
    const SpectralGrid grid({0.5, 0.6});
    const Vec3d d = stars_at(catalogue, parse_utc("2000-01-01T11:58:56Z"), 8, grid)[0].world_dir;
    EXPECT_NEAR(std::atan2(d.y, d.x) / kDegree_rad, 101.287155, 2e-5);
    EXPECT_NEAR(std::asin(d.z) / kDegree_rad, -16.716116, 2e-5);
    EXPECT_TRUE(stars_at(catalogue, parse_utc("2000-01-01T12:00:00Z"), -2, grid).empty());
}

// A star at right angles to a motion of 30 km/s stands 20.6 arcsec forward (v/c).
TEST(Stars, AberrationTurnsThemForward) {
    const Vec3d seen = aberrated({1, 0, 0}, {0, 30e3, 0});
    EXPECT_NEAR(std::atan2(seen.y, seen.x) / kArcsecond_rad, 30e3 / kSpeedOfLight_m_s / kArcsecond_rad, 1e-3);
    EXPECT_NEAR(length(aberrated({0, 1, 0}, {0, 30e3, 0})), 1, 1e-12);
    Star star;
    for (const Vec3d dir : {Vec3d{1, 0, 0}, normalized(Vec3d{1, -2, 3}), Vec3d{0, -1, 0}})
        for (const Vec3d velocity_m_s : {Vec3d{0, 30e3, 0}, Vec3d{-5e5, 6e5, 2e5}}) {
            star.world_dir = dir;
            const Vec3d mine = StarObserver(0, {}, velocity_m_s).apparent_dir(star);
            EXPECT_LT(length(mine - aberrated(dir, velocity_m_s)), 1e-15);
        }
}

// ERFA's own chain from the catalogue to the direction that a satellite sees: proper motion, parallax by its
// place, aberration by its velocity. ERFA bends the light by the Sun, hilcam does not: these stars are more
// than 60 degrees from it, where that is 7 mas at most.
TEST(Stars, ASatelliteSeesThemWhereErfaHasThem) {
    const SpectralGrid grid({0.5, 0.6});
    const TimeTai start = parse_utc("2026-06-21T00:00:00Z");
    CatalogueStar barnard;
    barnard.right_ascension_rad = 269.45402305 * kDegree_rad,
    barnard.declination_rad = 4.66828815 * kDegree_rad;
    barnard.pm_ra_cosdec_rad_yr = -797.84 * kMas_rad, barnard.pm_dec_rad_yr = 10326.93 * kMas_rad;
    barnard.parallax_rad = 549.01 * kMas_rad;
    for (const CatalogueStar& star : {sirius(), barnard})
        for (const double days : {0.0, 100.0, 3000.0})
            for (const Vec3d velocity_m_s : {Vec3d{}, Vec3d{0, 7600, 0}, Vec3d{-2e5, 2e5, 1e5}}) {
                const TimeTai time = start + static_cast<std::int64_t>(days * 86400e9);
                const JulianDate tt = julian_tt(time);
                const Vec3d place_m{7e6, 0, 0};
                const Bodies bodies = bodies_at(time, {});
                const Star at_start = stars_at(only(star), start, 8, grid)[0];
                const StarObserver satellite(days / 365.25,
                                             bodies.origin_from_barycenter.position_m + place_m,
                                             bodies.origin_from_barycenter.velocity_m_s + velocity_m_s);
                const Vec3d seen = satellite.apparent_dir(at_start);
                double pv[2][3] = {{place_m.x, place_m.y, place_m.z},
                                   {velocity_m_s.x, velocity_m_s.y, velocity_m_s.z}};
                eraASTROM astrom;
                eraApcs13(tt.day, tt.fraction, pv, &astrom);
                // ERFA wants places of J2000.0.
                double ra, dec, pm_ra, pm_dec, parallax, rv, seen_ra, seen_dec;
                eraPmsafe(star.right_ascension_rad, star.declination_rad,
                          star.pm_ra_cosdec_rad_yr / std::cos(star.declination_rad), star.pm_dec_rad_yr,
                          star.parallax_rad / kArcsecond_rad, 0, 2451545.0, (star.epoch_year - 2000) * 365.25,
                          2451545.0, 0, &ra, &dec, &pm_ra, &pm_dec, &parallax, &rv);
                eraAtciq(ra, dec, pm_ra, pm_dec, parallax, rv, &astrom, &seen_ra, &seen_dec);
                const Vec3d expected{std::cos(seen_dec) * std::cos(seen_ra),
                                     std::cos(seen_dec) * std::sin(seen_ra), std::sin(seen_dec)};
                const Vec3d sun = normalized(bodies.sun_world_m);
                // Both of the stars are within 60 degrees of it on some of these days.
                const double bent_mas = dot(sun, expected) < 0.5 ? 7.5 : 50;
                EXPECT_LT(length(seen - expected), bent_mas * kMas_rad) << days << " " << velocity_m_s.x;
            }
}

// Uniform over the sphere, with motions and parallaxes larger than any star's.
std::vector<Star> random_stars(std::size_t count) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    std::vector<Star> stars(count);
    for (std::size_t i = 0; i < count; ++i) {
        stars[i].world_dir = normalized(Vec3d{normal(random), normal(random), normal(random)});
        stars[i].motion_rad_yr = to_float(1e-4 * cross(stars[i].world_dir, Vec3d{0, 0, 1}));
        stars[i].parallax_rad = 4e-6f;
        stars[i].row = static_cast<std::uint32_t>(i);
    }
    return stars;
}

TEST(StarSky, AFieldHasTheStarsThatLookingAtAllOfThemFinds) {
    for (const std::size_t count : {0u, 1u, 700u, 60000u}) {
        const std::vector<Star> stars = random_stars(count);
        const StarSky sky(stars, {});
        ASSERT_EQ(sky.size(), count);
        const StarObserver observers[] = {{}, {-20, {1.5e11, 0, 3e10}, {1e5, -9e5, 3e5}}};
        for (const StarObserver& observer : observers)
            for (const Vec3d axis : {Vec3d{0, 0, 1}, Vec3d{0, 0, -1}, normalized(Vec3d{1, 1, 1}),
                                     normalized(Vec3d{1, -1, 0}), normalized(Vec3d{0.3, -0.2, -0.9})})
                for (const double angle_rad : {0.0, 1e-3, 0.15, 1.3, 2.0, kPi}) {
                    std::set<std::uint32_t> expected, found;
                    std::size_t seen = 0;
                    for (const Star& star : stars)
                        if (dot(observer.apparent_dir(star), axis) >= std::cos(angle_rad))
                            expected.insert(star.row);
                    sky.each_within(observer, axis, angle_rad, [&](const Star& star, Vec3d dir) {
                        ++seen;
                        EXPECT_LT(length(dir - observer.apparent_dir(stars[star.row])), 1e-15);
                        found.insert(star.row);
                    });
                    EXPECT_EQ(seen, found.size());
                    EXPECT_TRUE(std::includes(found.begin(), found.end(), expected.begin(), expected.end()))
                        << count << " " << angle_rad;
                    if (&observer == observers) {
                        EXPECT_LE(found.size(), sky.max_within(angle_rad));
                    }
                }
    }
}

}  // namespace
}  // namespace hilcam
