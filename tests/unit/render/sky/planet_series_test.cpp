#include "render/sky/planet_series.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/sky/bodies.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// One coordinate of a planet from the Sun or the Earth, as JPL's DE430 has it: lines of testpo.430, the
// values that JPL publishes with that ephemeris for such tests
// (ssd.jpl.nasa.gov/ftp/eph/planets/ascii/de430).
enum class Seen { kFromSun, kFromEarth };
struct Published {
    double jd_tdb;
    BodyId planet;
    Seen seen;
    int axis;
    double coordinate_au;
    double limit_arcsec;
};

constexpr Published kPublished[] = {
    {2437665.5, BodyId::kMercury, Seen::kFromSun, 0, 0.278002646893306, 0.1},     // 1962-01-01
    {2457082.5, BodyId::kMercury, Seen::kFromEarth, 0, 0.707537519703036, 0.1},   // 2015-03-01
    {2465332.5, BodyId::kMercury, Seen::kFromEarth, 1, -0.131717365580409, 0.1},  // 2037-10-01
    {2481130.5, BodyId::kMercury, Seen::kFromSun, 2, -0.082949709550304, 0.1},    // 2081-01-01
    {2436538.5, BodyId::kVenus, Seen::kFromEarth, 0, -0.479082388600882, 0.1},    // 1958-12-01
    {2461375.5, BodyId::kVenus, Seen::kFromEarth, 1, -0.185668281298106, 0.1},    // 2026-12-01
    {2469501.5, BodyId::kVenus, Seen::kFromEarth, 2, 0.042725023566409, 0.1},     // 2049-03-01
    {2487490.5, BodyId::kVenus, Seen::kFromSun, 2, 0.079314249974325, 0.1},       // 2098-06-01
    {2435625.5, BodyId::kMars, Seen::kFromSun, 0, 0.372640327879045, 0.2},        // 1956-06-01
    {2458362.5, BodyId::kMars, Seen::kFromEarth, 0, 0.213048674890409, 0.2},      // 2018-09-01
    {2460004.5, BodyId::kMars, Seen::kFromEarth, 0, 0.222249744041391, 0.2},      // 2023-03-01
    {2476502.5, BodyId::kMars, Seen::kFromSun, 1, 1.270035728120671, 0.2},        // 2068-05-01
    {2482895.5, BodyId::kMars, Seen::kFromEarth, 2, -0.591191994821341, 0.2},     // 2085-11-01
    {2436112.5, BodyId::kJupiter, Seen::kFromEarth, 1, -1.253002260376103, 0.3},  // 1957-10-01
    {2458119.5, BodyId::kJupiter, Seen::kFromSun, 1, -3.132950957415611, 0.3},    // 2018-01-01
    {2464753.5, BodyId::kJupiter, Seen::kFromEarth, 2, 1.433639850269305, 0.3},   // 2036-03-01
    {2469623.5, BodyId::kJupiter, Seen::kFromSun, 0, -1.067558069495748, 0.3},    // 2049-07-01
    {2433951.5, BodyId::kSaturn, Seen::kFromSun, 2, -0.114036449448843, 0.3},     // 1951-11-01
    {2459488.5, BodyId::kSaturn, Seen::kFromSun, 0, 6.613851777412065, 0.3},      // 2021-10-01
    {2459549.5, BodyId::kSaturn, Seen::kFromEarth, 1, -7.378094819550985, 0.3},   // 2021-12-01
    {2478298.5, BodyId::kSaturn, Seen::kFromSun, 0, -6.382669094332070, 0.3},     // 2073-04-01
    {2436842.5, BodyId::kUranus, Seen::kFromSun, 1, 11.233551761828460, 1.4},     // 1959-10-01
    {2461041.5, BodyId::kUranus, Seen::kFromEarth, 2, 6.237467846143550, 1.4},    // 2026-01-01
    {2476381.5, BodyId::kUranus, Seen::kFromSun, 0, -6.515792951564418, 1.4},     // 2068-01-01
    {2435533.5, BodyId::kNeptune, Seen::kFromSun, 2, -5.073631965915170, 2.1},    // 1956-03-01
    {2460857.5, BodyId::kNeptune, Seen::kFromEarth, 1, 1.137389139165530, 2.1},   // 2025-07-01
    {2485513.5, BodyId::kNeptune, Seen::kFromSun, 0, -25.824163147831701, 2.1},   // 2093-01-01
};

double component(Vec3d v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

constexpr double kJ2000_jd = 2451545, kUnixEpoch_jd = 2440587.5;

TimeTai tai_of(double jd_tdb) {
    return {std::llround((jd_tdb - kUnixEpoch_jd) * 86400) * 1'000'000'000 - 32'184'000'000};
}

}  // namespace

TEST(PlanetSeries, StandWhereJplsEphemerisHasThem) {
    for (const Published& row : kPublished) {
        const TimeTai time = tai_of(row.jd_tdb);
        Vec3d from = heliocentric(row.planet, time).position_m;
        if (row.seen == Seen::kFromEarth) from = from - heliocentric(BodyId::kEarth, time).position_m;
        const double error_m = component(from, row.axis) - row.coordinate_au * kAstronomicalUnit_m;
        EXPECT_LT(std::abs(error_m) / length(from) / kArcsecond_rad, row.limit_arcsec)
            << kBodyNames[index_of(row.planet)] << " at JD " << row.jd_tdb;
    }
}

// The velocity is the derivative of the same sums: against the position's difference over two hours, whose
// own error, step^2 / 6 of the third derivative, is 2e-6 of Mercury's speed at most.
TEST(PlanetSeries, VelocityIsThePositionsDerivative) {
    constexpr double kStep_d = 1.0 / 24;
    for (int i = 0; i <= static_cast<int>(Planet::kNeptune); ++i) {
        const auto planet = static_cast<Planet>(i);
        for (const double day : {-18262.0, 0.0, 9800.25, 54787.0}) {
            const Vec3d before = planet_by_series(planet, day - kStep_d).position_au,
                        after = planet_by_series(planet, day + kStep_d).position_au;
            const Vec3d velocity = planet_by_series(planet, day).velocity_au_d;
            EXPECT_LT(length((after - before) / (2 * kStep_d) - velocity), 1e-5 * length(velocity))
                << i << " at day " << kJ2000_jd + day;
        }
    }
}

}  // namespace hilcam
