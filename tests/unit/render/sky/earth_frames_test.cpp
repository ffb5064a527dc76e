#include "render/sky/earth_frames.h"

#include <gtest/gtest.h>

#include "render/vocabulary/earth_orientation.h"
#include "render/vocabulary/time_system.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

TimeTai at(CalendarTime calendar, TimeSystem system = TimeSystem::kUtc) {
    return from_calendar(calendar, system).value();
}

// ERFA's own test of eraC2t00b (t_erfa_c.c) is for TT = UT1 = MJD 53736 with polar motion; TT - UTC was
// 64.184 s until then. Their numbers are good to 1e-12, a UT1 that is kept to 1e-16 of a day likewise.
TEST(EarthFrames, TurnAsErfaTestsSay) {
    const EarthOrientation measured{64.184, 2.55060238e-7, 1.860359247e-6};
    const TimeTai time = at({2006, 1, 1, 0, 0, 0}, TimeSystem::kTt);
    const Mat3d found = earth_fixed_from_icrf(time, measured);
    constexpr double kTolerance = 2e-12;
    EXPECT_NEAR(found.x.x, -0.1810332128439678965, kTolerance);
    EXPECT_NEAR(found.x.y, 0.9834769806913872359, kTolerance);
    EXPECT_NEAR(found.x.z, 0.6555565082458415611e-4, kTolerance);
    EXPECT_NEAR(found.y.x, -0.9834768134115435923, kTolerance);
    EXPECT_NEAR(found.y.y, -0.1810332203784001946, kTolerance);
    EXPECT_NEAR(found.y.z, 0.5749793922030017230e-3, kTolerance);
    EXPECT_NEAR(found.z.x, 0.5773467471863534901e-3, kTolerance);
    EXPECT_NEAR(found.z.y, 0.3961790411549945020e-4, kTolerance);
    EXPECT_NEAR(found.z.z, 0.9999998325505635738, kTolerance);
}

// Vallado, Fundamentals of Astrodynamics and Applications, 4th ed., 2013, example 3-15 and table 3-6: one
// state of 2004-04-06T07:51:28.386009 UTC in several frames, with UT1 - UTC = -0.4399619 s. His GCRF comes by
// IAU 1976/1980 with the measured corrections, ours by IAU 2006/2000B without them: 1 mas of the latter,
// below 1 mas of free core nutation, and the complementary terms of the equinox (2.6 mas) that TEME leaves
// out, over 10,250 km: 0.25 m.
TEST(EarthFrames, TemeTurnsIntoIcrfAsPublished) {
    const TimeTai time = at({2004, 4, 6, 7, 51, 28.386009});
    const Vec3d found = icrf_from_teme(time, {}) * Vec3d{5094180.16210, 6127644.65950, 6380344.53270};
    EXPECT_LT(length(found - Vec3d{5102508.95290, 6123011.39910, 6378136.93380}), 0.25);
    // The velocity by the same turn: the axes' own is 1e-11 rad/s.
    const Vec3d velocity = icrf_from_teme(time, {}) * Vec3d{-4746.1314870, 785.8180410, 5531.9312880};
    EXPECT_LT(length(velocity - Vec3d{-4743.2201610, 790.5364950, 5533.7557240}), 2e-4);
}

// But for precession during UT1 - UTC, 46 arcsec a year (7e-12 rad/s).
TEST(EarthFrames, TemeDoesNotDependOnTheEarthsOrientation) {
    const TimeTai time = at({2004, 4, 6, 7, 51, 28.386009});
    const Mat3d without = icrf_from_teme(time, {});
    const EarthOrientation measured{-0.4399619, -0.140682 * kArcsecond_rad, 0.333309 * kArcsecond_rad};
    EXPECT_LT(length(icrf_from_teme(time, measured).x - without.x), 4e-12);
}

// Vallado 2013, example 3-15, by IAU 1976/1980 without the measured corrections: the same state in J2000, in axes of the true
// equator and equinox of date, and in those of the mean ones. Printed to 0.1 mm.
TEST(EarthFrames, TrueAndMeanOfDateAreAsPublished) {
    const TimeTai time = at({2004, 4, 6, 7, 51, 28.386009});
    const Vec3d j2000 = icrf_from_eme2000() * Vec3d{5102509.6000, 6123011.5200, 6378136.3000};
    const Vec3d velocity = icrf_from_eme2000() * Vec3d{-4743.2196000, 790.5366000, 5533.7561900};
    EXPECT_LT(length(icrf_from_true_of_date(time) * Vec3d{5094514.7804, 6127366.4612, 6380344.5328} - j2000),
              1e-3);
    EXPECT_LT(length(icrf_from_true_of_date(time) * Vec3d{-4746.088567, 786.077222, 5531.931288} - velocity),
              1e-5);
    EXPECT_LT(length(icrf_from_mean_of_date(time) * Vec3d{5094029.0167, 6127870.9363, 6380247.8885} - j2000),
              1e-3);
    // IAU 2006/2000A at 2026-03-20T12:00 (ERFA's eraPnm06a): 73 mas, the corrections of the pole, which 1980 lacks.
    const Mat3d icrf_from_true = icrf_from_true_of_date(at({2026, 3, 20, 12, 0, 0}));
    const Mat3d true_from_icrf{{0.9999793795935101, -0.0058899913713400, -0.0025589821070297},
                               {0.0058898781393997, 0.9999826531765716, -0.0000517826916644},
                               {0.0025592427164260, 0.0000367095311130, 0.9999967244591998}};
    const Mat3d apart = icrf_from_true * true_from_icrf;
    EXPECT_LT(length(Vec3d{apart.y.z, apart.z.x, apart.x.y}), 0.08 * kArcsecond_rad);
    EXPECT_GT(length(Vec3d{apart.y.z, apart.z.x, apart.x.y}), 0.06 * kArcsecond_rad);
}

// The bias of t_erfa_c.c, t_bp06.
TEST(EarthFrames, Eme2000HasTheFrameBias) {
    const Mat3d icrf = icrf_from_eme2000();
    EXPECT_NEAR(icrf.y.x, -0.7078368960971557145e-7, 1e-14);
    EXPECT_NEAR(icrf.z.x, 0.8056213977613185606e-7, 1e-14);
    EXPECT_NEAR(icrf.z.y, 0.3305943169218395e-7, 1e-14);
}

TEST(TimeSystems, DifferByWhatTheyAreDefinedBy) {
    const CalendarTime date{2020, 1, 1, 0, 0, 0};
    const TimeTai tai = at(date, TimeSystem::kTai);
    EXPECT_EQ(tai.ns, (50 * 365 + 12) * 86'400'000'000'000LL + 0LL);
    EXPECT_EQ(at(date, TimeSystem::kTt) - tai, -32'184'000'000);
    EXPECT_EQ(at(date, TimeSystem::kGps) - tai, 19'000'000'000);
    EXPECT_EQ(at(date, TimeSystem::kUtc) - tai, 37'000'000'000);
    // TDB - TT = 1657 us sin g, g the Earth's mean anomaly, -3 deg on January 1 (Fairhead & Bretagnon 1990;
    // the next terms are 22 us and 14 us).
    const double tdb_minus_tt_us =
        static_cast<double>(at(date, TimeSystem::kTt) - at(date, TimeSystem::kTdb)) * 1e-3;
    const double g = (357.53 + 0.98560028 * (2458849.5 - 2451545.0)) * kDegree_rad;
    EXPECT_NEAR(tdb_minus_tt_us, 1657 * std::sin(g), 50);
}

TEST(TimeSystems, RefuseDatesThatDoNotExist) {
    EXPECT_FALSE(from_calendar({2021, 2, 29, 0, 0, 0}, TimeSystem::kTai));
    EXPECT_FALSE(from_calendar({2021, 2, 28, 24, 0, 0}, TimeSystem::kTt));
    EXPECT_FALSE(from_calendar({2021, 2, 28, 23, 59, 60}, TimeSystem::kGps));
    EXPECT_FALSE(from_calendar({2021, 2, 28, 23, 59, 60.5}, TimeSystem::kUtc));
    EXPECT_TRUE(from_calendar({2016, 12, 31, 23, 59, 60.5}, TimeSystem::kUtc));
    EXPECT_FALSE(calendar_of_day(2021, 366));
    EXPECT_EQ(calendar_of_day(2020, 366)->day, 31);
    EXPECT_EQ(calendar_of_day(2021, 60)->month, 3);
}

// A table with a leap second that nobody ordered, and then ERFA's own again.
TEST(TimeSystems, LeapSecondsCanBeReplaced) {
    const auto offset_s = [](int year) {
        const CalendarTime date{year, 6, 1, 0, 0, 0};
        return static_cast<double>(at(date) - at(date, TimeSystem::kTai)) * 1e-9;
    };
    const double before_1972 = offset_s(1965);
    use_leap_seconds(std::vector<LeapSecond>{{1972, 1, 10}, {2017, 1, 37}, {2024, 1, 38}});
    EXPECT_EQ(offset_s(2025), 38);
    EXPECT_EQ(offset_s(2000), 10);
    EXPECT_EQ(offset_s(1965), before_1972);
    use_leap_seconds({});
    EXPECT_EQ(offset_s(2025), 37);
    EXPECT_EQ(offset_s(2000), 32);
}

}  // namespace
}  // namespace hilcam
