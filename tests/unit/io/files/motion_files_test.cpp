#include <gmock/gmock.h>

#include "io/files/aem_file.h"
#include "io/files/element_set.h"
#include "io/files/leap_seconds_file.h"
#include "io/files/oem_file.h"
#include "render/vocabulary/units.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

class MotionFiles : public FilesTest {
  protected:
    static std::string with(std::string text, const std::string& from, const std::string& to) {
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return at == std::string::npos ? text : text.replace(at, from.size(), to);
    }
};

// --- element sets ---

const std::string kIss =
    "ISS (ZARYA)\n"
    "1 25544U 98067A   14020.93268519  .00009878  00000-0  18200-3 0  5082\n"
    "2 25544  51.6498 109.4756 0003572  55.9686 274.8005 15.49815350868473\n";

TEST_F(MotionFiles, AnElementSetIsReadByItsColumns) {
    const ElementSet tle = read_element_sets(kIss, "iss.tle").at(0);
    EXPECT_EQ(tle.name, "ISS (ZARYA)");
    EXPECT_EQ(tle.satellite, "25544");
    EXPECT_EQ(tle.where, "iss.tle:2");
    EXPECT_DOUBLE_EQ(tle.inclination_rad, 51.6498 * kDegree_rad);
    EXPECT_DOUBLE_EQ(tle.eccentricity, 0.0003572);
    EXPECT_DOUBLE_EQ(tle.bstar_per_er, 1.82e-4);
    EXPECT_DOUBLE_EQ(tle.mean_motion_rad_min, 15.49815350 * 2 * kPi / 1440);
    // 2014-01-20 and 0.93268519 of a day; the double has 12 digits, the last of 0.9 ms.
    EXPECT_NEAR(static_cast<double>(tle.epoch - parse_utc("2014-01-20T22:23:04Z")), 0.000416e9, 1000);
    // 1950-01-01 is day 1; 2014-01-01 is 64 years and 16 leap days later.
    EXPECT_DOUBLE_EQ(tle.epoch_days_1950, 64 * 365 + 16 + 20.93268519);
}

TEST_F(MotionFiles, ABadElementSetIsNamedByItsPlace) {
    const auto message = [&](const std::string& from, const std::string& to) {
        return error_of([&] { read_element_sets(with(kIss, from, to), "iss.tle"); });
    };
    EXPECT_THAT(message("0  5082", "0  5083"),
                HasSubstr("iss.tle:2: found '3'; accepted: checksum 2 in column 69"));
    EXPECT_THAT(message("51.6498", "51.64x8"), HasSubstr("iss.tle:3: found"));
    EXPECT_THAT(message("2 25544", "2 25545"), HasSubstr("iss.tle:3"));
    EXPECT_THAT(message("868473", "86847"), HasSubstr("69 columns; it has 68"));
    EXPECT_THAT(error_of([] { read_element_sets("", "no.tle"); }), HasSubstr("no.tle: holds no element set"));
    EXPECT_THAT(error_of([] { load_element_sets("/nowhere/no.tle"); }), HasSubstr("no such file"));
    EXPECT_EQ(read_element_sets(with(kIss, "0  5082", "0  5083"), "iss.tle", TleChecksum::kIgnore).size(),
              1u);
    // The checksum holds, the satellites do not agree: the digit's sum is made up for elsewhere.
    EXPECT_THAT(error_of([&] {
                    read_element_sets(with(kIss, "2 25544", "2 25545"), "iss.tle", TleChecksum::kIgnore);
                }),
                HasSubstr("found '25545'; accepted: satellite 25544"));
}

TEST_F(MotionFiles, TheNewestSetBeforeAnInstantIsChosen) {
    std::vector<ElementSet> sets(3, read_element_sets(kIss, "iss.tle").at(0));
    sets[1].epoch = sets[0].epoch + 1000;
    sets[2].epoch = sets[0].epoch + 2000;
    const auto chosen = [&](std::int64_t after) {
        return choose_element_set(sets, "25544", sets[0].epoch + after, "iss.tle").epoch - sets[0].epoch;
    };
    EXPECT_EQ(chosen(1500), 1000);
    EXPECT_EQ(chosen(9999), 2000);
    EXPECT_EQ(chosen(-5), 0);
    EXPECT_EQ(&choose_element_set(sets, "ISS (ZARYA)", sets[0].epoch, "iss.tle"), &sets[0]);
    EXPECT_THAT(error_of([&] { choose_element_set(sets, "HST", {}, "iss.tle"); }),
                HasSubstr("has no satellite 'HST'"));
    sets[2].satellite = "20580";
    EXPECT_THAT(error_of([&] { choose_element_set(sets, "", {}, "iss.tle"); }),
                HasSubstr("several satellites"));
}

// --- orbit ephemerides ---

const std::string kOem =
    "CCSDS_OEM_VERS = 2.0\n"
    "COMMENT of nothing\n"
    "CREATION_DATE = 2026-01-01T00:00:00\n"
    "ORIGINATOR = BENCH\n"
    "META_START\n"
    "OBJECT_NAME = TARGET\n"
    "OBJECT_ID = 2026-001A\n"
    "CENTER_NAME = EARTH\n"
    "REF_FRAME = ITRF2000\n"
    "TIME_SYSTEM = TT\n"
    "START_TIME = 2026-001T00:00:32.184\n"
    "USEABLE_START_TIME = 2026-01-01T00:01:32.184\n"
    "STOP_TIME = 2026-01-01T00:03:32.184\n"
    "INTERPOLATION = HERMITE\n"
    "INTERPOLATION_DEGREE = 3\n"
    "META_STOP\n"
    "2026-01-01T00:00:32.184 7000 0 0 0 7.5 0\n"
    "2026-01-01T00:01:32.184 7000 450 0 0 7.5 0\n"
    "2026-01-01T00:03:32.184 7000 1350 0 0 7.5 0 0 0 0\n"
    "COVARIANCE_START\n"
    "EPOCH = 2026-01-01T00:00:32.184\n"
    "1\n"
    "COVARIANCE_STOP\n";

TEST_F(MotionFiles, AnOrbitEphemerisIsRead) {
    const std::vector<OemSegment> segments = read_oem(kOem, "t.oem");
    ASSERT_EQ(segments.size(), 1u);
    const OemSegment& s = segments[0];
    EXPECT_EQ(s.frame, CcsdsFrame::kEarthFixed);
    EXPECT_EQ(s.interpolation.method, InterpolationMethod::kHermite);
    EXPECT_EQ(s.interpolation.degree, 3);
    ASSERT_EQ(s.states.size(), 3u);
    // TT of 32.184 s after midnight is TAI of midnight.
    EXPECT_EQ(s.states[0].time.ns, 20454LL * 86'400'000'000'000);
    EXPECT_EQ(s.usable_start - s.states[0].time, 60'000'000'000);
    EXPECT_EQ(s.usable_stop - s.states[0].time, 180'000'000'000);
    EXPECT_EQ(s.states[1].position_m.y, 450e3);
    EXPECT_EQ(s.states[2].velocity_m_s.y, 7500);
    EXPECT_EQ(s.line, 5);
}

TEST_F(MotionFiles, ABadOrbitEphemerisIsNamedByItsPlace) {
    const auto message = [&](const std::string& from, const std::string& to) {
        return error_of([&] { read_oem(with(kOem, from, to), "t.oem"); });
    };
    EXPECT_THAT(message("CCSDS_OEM_VERS = 2.0", "CCSDS_OEM_VERS = 9"), HasSubstr("t.oem:1: found '9'"));
    EXPECT_THAT(message("= ITRF2000", "= TNW"),
                HasSubstr("t.oem:9: found 'TNW'; accepted: REF_FRAME of ICRF, GCRF, EME2000"));
    EXPECT_THAT(message("TIME_SYSTEM = TT", "TIME_SYSTEM = MRT"),
                HasSubstr("t.oem:10: found 'MRT'; accepted: TIME_SYSTEM of UTC"));
    EXPECT_THAT(message("OBJECT_ID = 2026-001A\n", ""),
                HasSubstr("t.oem:15: the section that ends here has no OBJECT_ID"));
    EXPECT_THAT(message("2026-001T00:00:32.184", "2026-367T00:00:32.184"),
                HasSubstr("t.oem:11: found '2026-367T"));
    EXPECT_THAT(message("DEGREE = 3", "DEGREE = 32"),
                HasSubstr("t.oem:15: found '32'; accepted: INTERPOLATION_DEGREE"));
    EXPECT_THAT(message("450 0 0 7.5 0\n", "450 0 0 7.5\n"), HasSubstr("t.oem:18: found"));
    EXPECT_THAT(message("450 0", "4x50 0"), HasSubstr("t.oem:18: found '4x50'; accepted: a number"));
    EXPECT_THAT(message("2026-01-01T00:03:32.184 7000", "2026-01-01T00:01:02.184 7000"),
                HasSubstr("epochs that rise"));
    EXPECT_THAT(message("2026-01-01T00:03:32.184 7000", "2026-01-01T00:03:31.184 7000"),
                HasSubstr("do not reach over its usable span"));
    EXPECT_THAT(message("2026-01-01T00:01:32.184 7000", "2026-01-01T00:00:32.184000001 7000"),
                HasSubstr("within a factor of a million"));
    EXPECT_THAT(message("USEABLE_START_TIME = 2026-01-01T00:01", "USEABLE_START_TIME = 2026-01-01T00:09"),
                HasSubstr("out of order"));
    EXPECT_THAT(message("OBJECT_NAME", "OBJECT_NAM"),
                HasSubstr("t.oem:16: the section that ends here has no OBJECT_NAME"));
    EXPECT_THAT(message("COVARIANCE_STOP\n", ""), HasSubstr("accepted: COVARIANCE_STOP"));
    EXPECT_THAT(error_of([] { read_oem(kOem, "t.oem", "OTHER"); }), HasSubstr("has no object 'OTHER'"));
}

// --- attitude ephemerides ---

std::string aem(const std::string& meta, const std::string& data) {
    return "CCSDS_AEM_VERS = 2.0\nMETA_START\nOBJECT_NAME = T\nOBJECT_ID = T\nREF_FRAME_A = "
           "ICRF\nREF_FRAME_B = "
           "SC_BODY_1\nTIME_SYSTEM = TAI\nSTART_TIME = 2026-01-01T00:00:00\nSTOP_TIME = "
           "2026-01-01T00:01:00\n" +
           meta + "META_STOP\nDATA_START\n" + data + "DATA_STOP\n";
}
AttitudeSample first_of(const std::string& meta, const std::string& numbers) {
    return read_aem(aem(meta, "2026-01-01T00:00:00 " + numbers + "\n2026-01-01T00:01:00 " + numbers + "\n"),
                    "t.aem")
        .at(0)
        .attitudes.at(0);
}
void expect_near(Quat a, Quat b, double tolerance) {
    const double sign = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z < 0 ? -1 : 1;
    EXPECT_NEAR(a.w, sign * b.w, tolerance);
    EXPECT_NEAR(a.x, sign * b.x, tolerance);
    EXPECT_NEAR(a.y, sign * b.y, tolerance);
    EXPECT_NEAR(a.z, sign * b.z, tolerance);
}

// 504.0-B-2, annex F2.2: B is A turned by 90 deg about z, so that B's x axis is A's y axis.
TEST_F(MotionFiles, QuaternionsAreTheStandardsOwn) {
    const AttitudeSample s = first_of("ATTITUDE_TYPE = QUATERNION\n", "0 0 0.70710678 0.70710678");
    const Vec3d x = to_matrix(s.reference_from_body) * Vec3d{1, 0, 0};
    EXPECT_NEAR(x.y, 1, 1e-7);
    // Version 1 may have the scalar first and the other direction.
    const AttitudeSample back =
        first_of("ATTITUDE_DIR = B2A\nQUATERNION_TYPE = FIRST\nATTITUDE_TYPE = QUATERNION\n",
                 "0.70710678 0 0 -0.70710678");
    expect_near(back.reference_from_body, s.reference_from_body, 1e-9);
}

// Annex F5.4's worked example; F5.2's rule.
TEST_F(MotionFiles, SpinIsTheStandardsOwn) {
    const AttitudeSample s = first_of("ATTITUDE_TYPE = SPIN\n", "0 80 45 1");
    expect_near(s.reference_from_body, {0.3812, 0.0805, 0.0334, 0.9204}, 0.6e-4);
    EXPECT_NEAR(s.rate_body_rad_s.z, kDegree_rad, 1e-15);
}

// The rates of both spellings are those of finite differences of the attitudes.
TEST_F(MotionFiles, RatesBelongToTheAttitudes) {
    for (const std::string direction : {"", "ATTITUDE_DIR = B2A\n"}) {
        const std::string meta = direction + "ATTITUDE_TYPE = EULER_ANGLE/DERIVATIVE\nEULER_ROT_SEQ = ZXY\n";
        const auto angles = [&](double t) {
            return std::to_string(10 + 3 * t) + " " + std::to_string(20 - 2 * t) + " " +
                   std::to_string(30 + 5 * t);
        };
        const AttitudeSample a = first_of(meta, "10 20 30 3 -2 5");
        // Angles that are seven digits apart: 1 s, and the turn as it is then halved.
        const Quat before = first_of(meta, angles(-1) + " 0 0 0").reference_from_body;
        const Quat after = first_of(meta, angles(1) + " 0 0 0").reference_from_body;
        Quat turn = conjugate(before) * after;
        if (turn.w < 0) turn = {-turn.w, -turn.x, -turn.y, -turn.z};
        // Third order in the turn of 6 deg each way: a percent of it.
        EXPECT_NEAR(turn.x, a.rate_body_rad_s.x, 0.02 * length(a.rate_body_rad_s)) << direction;
        EXPECT_NEAR(turn.y, a.rate_body_rad_s.y, 0.02 * length(a.rate_body_rad_s)) << direction;
        EXPECT_NEAR(turn.z, a.rate_body_rad_s.z, 0.02 * length(a.rate_body_rad_s)) << direction;
    }
    // dq/dt = q omega / 2 for omega = (0, 0, 0.2) at q = 1.
    const AttitudeSample d = first_of("ATTITUDE_TYPE = QUATERNION/DERIVATIVE\n", "0 0 0 1 0 0 0.1 0");
    EXPECT_NEAR(d.rate_body_rad_s.z, 0.2, 1e-15);
    // Components in A: the body's y axis is A's -x.
    const AttitudeSample w = first_of("ATTITUDE_TYPE = QUATERNION/ANGVEL\nANGVEL_FRAME = ICRF\n",
                                      "0 0 0.70710678 0.70710678 1 0 0");
    EXPECT_NEAR(w.rate_body_rad_s.y, -kDegree_rad, 1e-9);
}

TEST_F(MotionFiles, ABadAttitudeEphemerisIsNamedByItsPlace) {
    const auto message = [&](const std::string& meta, const std::string& data) {
        return error_of([&] { read_aem(aem(meta, data), "t.aem"); });
    };
    const std::string line = "2026-01-01T00:00:00 0 0 0 1\n";
    EXPECT_THAT(message("ATTITUDE_TYPE = SPIN/NUTATION\n", line),
                HasSubstr("t.aem:10: found 'SPIN/NUTATION'; accepted: ATTITUDE_TYPE of QUATERNION,"));
    EXPECT_THAT(message("ATTITUDE_TYPE = QUATERNION\n", "2026-01-01T00:00:00 0 0 0 2\n"),
                HasSubstr("t.aem:13: found a quaternion of norm 2"));
    EXPECT_THAT(message("ATTITUDE_TYPE = QUATERNION\n", line), HasSubstr("t.aem:2: the segment"));
    EXPECT_THAT(message("ATTITUDE_TYPE = EULER_ANGLE\nEULER_ROT_SEQ = XXZ\n", line),
                HasSubstr("found 'XXZ'"));
    EXPECT_THAT(message("ATTITUDE_TYPE = EULER_ANGLE\n", line), HasSubstr("has no EULER_ROT_SEQ"));
    EXPECT_THAT(error_of([&] {
                    read_aem(with(aem("ATTITUDE_TYPE = QUATERNION\n", line), "SC_BODY_1", "GCRF"), "t.aem");
                }),
                HasSubstr("one frame of the body"));
}

// --- leap seconds ---

const std::string kLeaps =
    "#\tATOMIC TIME\n#$\t3960835200\n#@\t3991593600\n2272060800\t10\t# 1 Jan 1972\n3692217600 37 # 1 Jan "
    "2017\n";

TEST_F(MotionFiles, LeapSecondsAreRead) {
    const LeapSecondsFile file = read_leap_seconds(kLeaps, "l.list");
    ASSERT_EQ(file.table.size(), 2u);
    EXPECT_EQ(file.table[0].year, 1972);
    EXPECT_EQ(file.table[1].year, 2017);
    EXPECT_EQ(file.table[1].month, 1);
    EXPECT_EQ(file.table[1].tai_minus_utc_s, 37);
    // 3991593600 s after 1900 is 2026-06-28 (the file's own words).
    EXPECT_EQ(file.expires, parse_utc("2026-06-28T00:00:00Z"));
}

TEST_F(MotionFiles, ABadLeapSecondListIsNamedByItsPlace) {
    const auto message = [&](const std::string& from, const std::string& to) {
        return error_of([&] { read_leap_seconds(with(kLeaps, from, to), "l.list"); });
    };
    EXPECT_THAT(message("#@\t3991593600\n", ""), HasSubstr("l.list: has no date of expiry"));
    EXPECT_THAT(message("3692217600", "3692217601"), HasSubstr("l.list:5: found '3692217601 37'"));
    EXPECT_THAT(message("3692217600", "2272060800"), HasSubstr("dates that rise"));
    EXPECT_THAT(message("3692217600 37", "3692217600"), HasSubstr("TAI - UTC"));
    EXPECT_THAT(error_of([] { read_leap_seconds("", "l.list"); }), HasSubstr("has no leap second"));
}

}  // namespace
}  // namespace hilcam
