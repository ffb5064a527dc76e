#include "io/spice/text_kernel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/spice/ephemeris_time.h"
#include "io/spice/frame_definition.h"
#include "io/spice/instrument_kernel.h"
#include "io/spice/kernel_names.h"
#include "io/spice/spacecraft_clock.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

KernelPool pool_of(const std::string& text) {
    KernelPool pool;
    read_text_kernel("KPL/TEST\n\\begindata\n" + text, "t.tf", pool);
    return pool;
}
template <class F>
std::string refusal(const F& f) {
    try {
        f();
    } catch (const InputError& error) {
        return error.what();
    }
    return "nothing";
}

const char* const kLeapSeconds =
    "DELTET/DELTA_T_A = 32.184\nDELTET/K = 1.657D-3\nDELTET/EB  = 1.671D-2\nDELTET/M = ( 6.239996   "
    "1.99096871D-7 )\n"
    "DELTET/DELTA_AT = ( 10, @1972-JAN-1\n 31, @1997-JUL-1 32, @1999-JAN-1 37, @2017-JAN-1 )\n";

TEST(TextKernel, AssignmentsOfEveryFormAreRead) {
    const KernelPool pool = pool_of(
        "A = 1\n B=( 1.5D3, -2e-1 +3 )\nC = 'it''s'\n\\begintext\nA = 7\n\\begindata\nC+='two'\n"
        "D = (\n 'x'\n 'y' )\n E =\n 5\nF = ( @feb/4/1987 @March-7-1987-3:10:39.221 )\nA += ( 2 3 )\n");
    EXPECT_THAT(*pool.numbers("A"), ElementsAre(1, 2, 3));
    EXPECT_THAT(*pool.numbers("B"), ElementsAre(1500, -0.2, 3));
    EXPECT_THAT(*pool.texts("C"), ElementsAre("it's", "two"));
    EXPECT_THAT(*pool.texts("D"), ElementsAre("x", "y"));
    EXPECT_EQ(pool.number("E"), 5);
    EXPECT_EQ(pool.numbers("F")->size(), 2u);
    EXPECT_EQ(pool.find("D")->where, "t.tf:10");
    EXPECT_FALSE(pool.numbers("G"));
}

TEST(TextKernel, DatesCountFromNoonOfThe1stOfJanuary2000) {
    for (const char* text : {"2000-JAN-1/12:00", "1-JAN-2000-12:00:00", "jan/1/2000/12",
                             "2000-01-01T12:00:00.0", "2000-001T12:00"})
        EXPECT_EQ(kernel_date_s(text), 0) << text;
    EXPECT_EQ(kernel_date_s("1972-JAN-1"), -43200 - 10227 * 86400.0);
    EXPECT_EQ(kernel_date_s("04-SEP-1990//4:23:00"), -43200 - 3406 * 86400.0 + 4 * 3600 + 23 * 60);
    EXPECT_EQ(kernel_date_s("2024-FEB-29"), -43200 + 8825 * 86400.0);
    for (const char* text :
         {"", "yesterday", "2000", "2000-13-01", "2000-JAN-40", "1-2-3", "2000-JAN-1/1:2:3:4"})
        EXPECT_FALSE(kernel_date_s(text)) << text;
}

TEST(TextKernel, MistakesAreNamedWithTheirLine) {
    const auto why = [](const std::string& text) { return refusal([&] { pool_of(text); }); };
    EXPECT_THAT(
        why("A = one"),
        HasSubstr("t.tf:3: found 'one'; accepted: a number, a text between single quotes, or @ and a date"));
    EXPECT_THAT(why("A 1"), HasSubstr("t.tf:3: found '1'; accepted: = or += after 'A'"));
    EXPECT_THAT(why("A = ( 1 'x' )"), HasSubstr("found 'x'; accepted: numbers, as before in 'A'"));
    EXPECT_THAT(why("A = ( 1\n2"), HasSubstr("t.tf:3: 'A' has no end"));
    EXPECT_THAT(why("A = 'x"), HasSubstr("a text that ends with a single quote on its line"));
    EXPECT_THAT(why("A = ( )"), HasSubstr("'A': found no value"));
    EXPECT_THAT(why("A = 1\nA += 'x'"), HasSubstr("t.tf:4: adds texts to A, which has numbers (t.tf:3)"));
}

TEST(EphemerisTime, IsThatOfNaifsLeapSecondKernels) {
    const EphemerisTime time = ephemeris_time(pool_of(kLeapSeconds));
    // SpiceyPy's test suite: str2et("06-28-2000"), deltet at 2004-01-01 (its test_deltet).
    EXPECT_NEAR(time.et_s(parse_utc("2000-06-28T00:00:00Z")), 15422464.184185712, 1e-8);
    const double et_2004 = time.et_s(parse_utc("2004-01-01T00:00:00Z"));
    EXPECT_NEAR(et_2004 - 1461 * 86400.0 + 43200, 64.1839116, 1e-6);
    for (const char* utc :
         {"1975-05-05T01:02:03.123456789Z", "2015-06-30T23:59:60.5Z", "2190-01-01T00:00:00Z"})
        EXPECT_NEAR(static_cast<double>(time.tai(time.et_s(parse_utc(utc))) - parse_utc(utc)), 0, 1000)
            << utc;
    // TDB as the IAU has it is 30 us away at most.
    const auto tdb = from_calendar({2030, 6, 1, 0, 0, 0}, TimeSystem::kTdb);
    EXPECT_NEAR(time.et_s(*tdb), 11109 * 86400.0 - 43200, 60e-6);
    const std::vector<LeapSecond> leaps = leap_seconds_of(pool_of(kLeapSeconds));
    ASSERT_EQ(leaps.size(), 4u);
    EXPECT_EQ(leaps[1].year, 1997);
    EXPECT_EQ(leaps[1].month, 7);
    EXPECT_EQ(leaps[1].tai_minus_utc_s, 31);
    EXPECT_THAT(refusal([] { leap_seconds_of(pool_of("DELTET/DELTA_AT = ( 10 @1972-JAN-2 )")); }),
                HasSubstr("the first of a month"));
}

TEST(SpacecraftClock, RunsEvenlyFromTripleToTriple) {
    const std::string text =
        "SCLK_DATA_TYPE_99 = 1\nSCLK01_TIME_SYSTEM_99 = ( 2 )\nSCLK01_MODULI_99 = ( 4294967296 256 )\n"
        "SCLK01_COEFFICIENTS_99 = ( 0 100 1\n 2560 110 1.01 )\n";
    const EphemerisTime time;
    const SpacecraftClock clock(pool_of(text), -99, time);
    const double offset = 105 - time.tt_s(105);  // parallel time is TT
    EXPECT_NEAR(clock.ticks(105 + offset), 1280, 1e-6);
    EXPECT_NEAR(clock.ticks(110 + 1.01 + offset), 2560 + 256, 1e-6);
    EXPECT_NEAR(clock.et_s(clock.ticks(123.456)), 123.456, 1e-9);
    EXPECT_NEAR(clock.seconds_per_tick(120), 1.01 / 256, 1e-15);
    EXPECT_THAT(refusal([&] { SpacecraftClock(pool_of(text), -98, time); }),
                HasSubstr("no kernel has SCLK01_MODULI_98, which the clock -98 needs"));
    EXPECT_THAT(refusal([&] {
                    SpacecraftClock(
                        pool_of("SCLK01_MODULI_99 = 256\nSCLK01_COEFFICIENTS_99 = ( 5 1 1 4 2 1 )"), -99,
                        time);
                }),
                HasSubstr("triple 2"));
}

TEST(KernelNames, KernelsComeBeforeTheProgramsOwnNames) {
    const KernelPool pool = pool_of("NAIF_BODY_NAME += ( 'MY SHIP' 'MARS' )\nNAIF_BODY_CODE += ( -99 4 )\n");
    EXPECT_EQ(kernel_code(pool, "my_ship"), -99);
    EXPECT_EQ(kernel_code(pool, "Mars"), 4);
    EXPECT_EQ(kernel_code(pool, "-12"), -12);
    EXPECT_EQ(kernel_code(KernelPool(), "Earth Moon  Barycenter"), 3);
    EXPECT_EQ(kernel_code(KernelPool(), "bennu"), 2101955);
    EXPECT_THAT(refusal([&] { require_kernel_code(pool, "nemo", "spice.object"); }),
                HasSubstr("spice.object: found 'nemo'; accepted:"));
}

TEST(FrameDefinition, OffsetsByAnglesMatrixAndQuaternionAreTheSame) {
    const double c = std::cos(0.5), s = std::sin(0.5);
    const auto frame = [&](const std::string& offset) {
        return frame_named(pool_of("FRAME_X = -99001\nFRAME_-99001_NAME = 'X'\nFRAME_-99001_CLASS = "
                                   "4\nFRAME_-99001_CLASS_ID = -99001\n"
                                   "TKFRAME_-99001_RELATIVE = 'ECLIPJ2000'\n" +
                                   offset),
                           "x", "key");
    };
    // [0.5]3 takes vectors of X to those of ECLIPJ2000.
    const Mat3d expected{{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
    const std::string m = std::to_string(c) + " " + std::to_string(-s) + " 0 " + std::to_string(s) + " " +
                          std::to_string(c) + " 0 0 0 1";
    const std::string q = std::to_string(std::cos(0.25)) + " 0 0 " + std::to_string(-std::sin(0.25));
    for (const std::string& offset :
         {std::string(
              "TKFRAME_X_SPEC = 'ANGLES'\nTKFRAME_X_ANGLES = ( 0 0.5 0 )\nTKFRAME_X_AXES = ( 1 3 2 )\n"
              "TKFRAME_X_UNITS = 'RADIANS'\n"),
          "TKFRAME_-99001_SPEC = 'MATRIX'\nTKFRAME_-99001_MATRIX = ( " + m + " )\n",
          "TKFRAME_-99001_SPEC = 'QUATERNION'\nTKFRAME_-99001_Q = ( " + q + " )\n"}) {
        const FrameDefinition x = frame(offset);
        EXPECT_EQ(x.relative, 17);
        EXPECT_NEAR(length(x.relative_from_frame.x - expected.x), 0, 2e-6) << offset;
        EXPECT_NEAR(length(x.relative_from_frame.y - expected.y), 0, 2e-6) << offset;
    }
    EXPECT_THAT(refusal([&] { frame("TKFRAME_X_SPEC = 'ANGLES'\n"); }),
                HasSubstr("no kernel has TKFRAME_-99001_ANGLES"));
    EXPECT_THAT(refusal([&] { frame_named(pool_of("FRAME_Y = 5000\nFRAME_5000_CLASS = 6\n"), "Y", "k"); }),
                HasSubstr("found class 6; accepted: 2 (PCK), 3 (CK), 4 (fixed offset), 5 (dynamic)"));
    EXPECT_THAT(refusal([&] { frame_named(KernelPool(), "NOWHERE", "attitude.spice.frame"); }),
                HasSubstr("attitude.spice.frame: found the frame 'NOWHERE'"));
    EXPECT_EQ(frame_named(KernelPool(), "iau_mars", "k").class_code, 499);
    EXPECT_EQ(frame_coded(KernelPool(), 10040, "k").class_code, 602);
}

// JunoCam's kernel has the middle of the distortion, from the first pixel's middle as 0, and of a strip's own rows; Cassini's has CCD_CENTER = (511.5,
// 511.5) of 1024 pixels; others count from 1.
TEST(InstrumentKernel, TheBoresightsPixelIsRead) {
    const auto center = [](const std::string& text) {
        return instrument_kernel(pool_of("INS-1_PIXEL_SAMPLES = 1024\nINS-1_PIXEL_LINES = 1024\n" + text),
                                 "-1", "k")
            .center_px.value_or(Vec2d{-1, -1});
    };
    EXPECT_EQ(center("").x, -1);
    EXPECT_EQ(center("INS-1_DISTORTION_X = 814.21\nINS-1_DISTORTION_Y = -151.52\n").x, 814.71);
    EXPECT_EQ(center("INS-1_DISTORTION_X = 814.21\nINS-1_DISTORTION_Y = -151.52\n").y, -151.02);
    EXPECT_EQ(center("INS-1_CCD_CENTER = ( 511.5 511.5 )\n").x, 512);
    EXPECT_EQ(center("INS-1_CCD_CENTER = ( 512.5 512.5 )\n").y, 512);
    EXPECT_EQ(center("INS-1_CCD_CENTER = ( 500 498 )\n").y, 498.5);
    EXPECT_EQ(center("INS-1_DISTORTION_X = 814.21\n").x, -1);
    EXPECT_THAT(refusal([&] { center("INS-1_CCD_CENTER = ( 1e9 0 )\n"); }),
                HasSubstr("INS-1_CCD_CENTER: found"));
    EXPECT_THAT(refusal([&] { center("INS-1_CCD_CENTER = ( 1 2 3 )\n"); }), HasSubstr("INS-1_CCD_CENTER"));
}

TEST(InstrumentKernel, ACameraIsReadWithItsUnits) {
    const InstrumentKernel k = instrument_kernel(
        pool_of("INS-99100_FOCAL_LENGTH = 150\nINS-99100_PIXEL_SIZE = ( 14.0 13.9 )\nINS-99100_PIXEL_SAMPLES "
                "= 1024\nINS-99100_PIXEL_LINES = 512\n"
                "INS-99100_FOV_FRAME = 'CAM'\nINS-99100_BORESIGHT = ( 0 0 9 )\nINS-99100_FOV_SHAPE = "
                "'RECTANGLE'\nINS-99100_FOV_CLASS_SPEC = 'ANGLES'\n"
                "INS-99100_FOV_REF_ANGLE = 3\nINS-99100_FOV_CROSS_ANGLE = 4\nINS-99100_FOV_ANGLE_UNITS = "
                "'DEGREES'\n"),
        "-99100", "k");
    EXPECT_NEAR(*k.focal_length_m, 0.15, 1e-15);
    EXPECT_NEAR(*k.pitch_m, 14e-6, 1e-18);
    EXPECT_EQ(*k.samples, 1024);
    EXPECT_EQ(*k.lines, 512);
    EXPECT_EQ(k.frame, "CAM");
    EXPECT_NEAR(std::tan(*k.half_field_rad), std::hypot(std::tan(3 * kDegree_rad), std::tan(4 * kDegree_rad)),
                1e-12);
    for (const auto& [text, pitch_m] : {std::pair{"0.009", 9e-6}, {"7e-06", 7e-6}, {"12", 12e-6}})
        EXPECT_NEAR(*instrument_kernel(pool_of(std::string("INS-1_PIXEL_SIZE = ") + text), "-1", "k").pitch_m,
                    pitch_m, 1e-18);
    EXPECT_THAT(refusal([] { instrument_kernel(KernelPool(), "-5", "spice.camera"); }),
                HasSubstr("spice.camera: found '-5', and no kernel has INS-5_"));
}

}  // namespace
}  // namespace hilcam
