#include <gtest/gtest.h>

#include <random>

#include "render/bodies.h"
#include "render/check.h"
#include "render/earth_rays.h"
#include "render/stars.h"
#include "render/units.h"

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
    const Vec3d sun = normalized(earth_fixed_from_icrf(time) * sun_from_earth_m(time));
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
    const Spectrum s = grid.average({{0.4, 0.9}, {0, 1}});
    EXPECT_NEAR(s[0], 0.2, 1e-6);
    EXPECT_NEAR(s[1], 0.7, 1e-6);
    EXPECT_EQ(s[2], 0);
}

TEST(Spectrum, SunsBlackBodyCarriesTheSolarConstant) {
    // 8 bins from 0.2 to 2.5 um hold 96 % of a 5772 K black body (Planck's integral by series).
    std::vector<double> edges;
    for (int i = 0; i <= 8; ++i) edges.push_back(0.2 + i * 2.3 / 8);
    const SpectralGrid grid(edges);
    const Spectrum s = solar_irradiance_1au_w_m2_um(grid);
    double total = 0;
    for (int b = 0; b < 8; ++b) total += static_cast<double>(s[b]) * grid.width_um(b);
    const auto below = [](double wavelength_um) {
        // Fraction of a black body's radiation below a wavelength: 15/pi^4 sum e^-nx (x^3/n + 3x^2/n^2 +
        // 6x/n^3 + 6/n^4).
        const double x = kPlanck_j_s * kSpeedOfLight_m_s /
                         (wavelength_um * 1e-6 * kBoltzmann_j_k * kSunEffectiveTemperature_k);
        double sum = 0;
        for (int n = 1; n < 50; ++n)
            sum += std::exp(-n * x) *
                   (x * x * x / n + 3 * x * x / (n * n) + 6 * x / std::pow(n, 3) + 6 / std::pow(n, 4));
        return 15 / std::pow(kPi, 4) * sum;
    };
    EXPECT_NEAR(total / ((below(2.5) - below(0.2)) * kTotalSolarIrradiance_w_m2), 1, 2e-3);
}

TEST(Spectrum, RefusesBadEdges) {
    EXPECT_THROW(SpectralGrid({0.5}), InputError);
    EXPECT_THROW(SpectralGrid({0.5, 0.4}), InputError);
    EXPECT_THROW(SpectralGrid({0.1, 0.4}), InputError);
}

TEST(Stars, VegaHasTheFluxOfMagnitudeZero) {
    const SpectralGrid grid({0.545, 0.555});
    // 3.63e-8 W m^-2 um^-1 at 0.55 um for V = 0 (Bessell et al. 1998); 100 times less five magnitudes on.
    EXPECT_NEAR(star_irradiance_w_m2_um(0, 0, grid)[0] / 3.63e-8, 1, 1e-3);
    EXPECT_NEAR(star_irradiance_w_m2_um(5, 0, grid)[0] / 3.63e-10, 1, 1e-3);
}

TEST(Stars, ColourTemperatureOfTheSun) {
    // B-V = 0.656 (Gray 1992) gives 5772 K within 2 % by Ballesteros' formula.
    EXPECT_NEAR(color_temperature_k(0.656) / 5772, 1, 0.02);
}

TEST(Stars, ProperMotionMovesSirius) {
    // Sirius: -546.01, -1223.07 mas/yr (Hipparcos); J1991.25 place to J2000.0 (SIMBAD: 101.287155
    // -16.716116).
    StarCatalogue catalogue;
    catalogue.stars.push_back({48915, 101.28854 * kDegree_rad, -16.71314 * kDegree_rad,
                               -546.01e-3 * kArcsecond_rad, -1223.07e-3 * kArcsecond_rad, -1.44, 0});
    const SpectralGrid grid({0.5, 0.6});
    const Vec3d d = stars_at(catalogue, parse_utc("2000-01-01T11:58:56Z"), 8, grid)[0].world_dir;
    EXPECT_NEAR(std::atan2(d.y, d.x) / kDegree_rad, 101.287155, 2e-5);
    EXPECT_NEAR(std::asin(d.z) / kDegree_rad, -16.716116, 2e-5);
    EXPECT_TRUE(stars_at(catalogue, parse_utc("2000-01-01T12:00:00Z"), -2, grid).empty());
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
        const EarthRays rays(camera, sun, corner, right, down);
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
