#include "io/spice/dynamic_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "io/spice/kernel_bodies.h"
#include "io/spice/text_kernel.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"
#include "tests/support/spice_writer.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

std::string frame_text(const std::string& rest, const std::string& relative = "J2000") {
    return "\\begindata\nFRAME_DYN = 5000\nFRAME_5000_NAME = 'DYN'\nFRAME_5000_CLASS = "
           "5\nFRAME_5000_CLASS_ID = "
           "5000\nFRAME_5000_CENTER = 399\nFRAME_5000_RELATIVE = '" +
           relative + "'\nFRAME_5000_DEF_STYLE = 'PARAMETERIZED'\n" + rest;
}

// A satellite on a circle of 7000 km about the Earth, by type 17: a turn in so many seconds.
constexpr double kRate_rad_s = 1.1e-3;
WrittenArray circular_orbit(int frame = 1) {
    return {"TEST",
            -1e6,
            1e6,
            {-99, 399, frame, 17},
            {0, 7000, 0, 0, 0.3, 0, 0.4, 0, kRate_rad_s, 0, -kPi / 2, kPi / 2}};
}

struct Kernels {
    KernelSet set;
    KernelFrames frames{set};
    KernelBodies bodies{set, frames};

    explicit Kernels(const std::string& text, int frame = 1) {
        read_text_kernel(text, "t.tf", set.pool);
        set.binaries.push_back(
            std::make_unique<DafFile>(SpiceWriter("SPK").add(circular_orbit(frame)).bytes(), "test.bsp"));
    }
    FrameTurn turn(double et_s) {
        FrameTurn out;
        EXPECT_TRUE(frames.turn(frames.require("DYN", "test"), et_s, out)) << et_s;
        return out;
    }
    bool knows(double et_s) {
        FrameTurn out;
        return frames.turn(frames.require("DYN", "test"), et_s, out);
    }
};
std::string frame_refusal(const std::string& text) {
    try {
        Kernels(text).turn(0);
    } catch (const InputError& error) {
        return error.what();
    }
    return "nothing";
}

void expect_same(const Mat3d& a, const Mat3d& b, double tolerance) {
    EXPECT_NEAR(length(a.x - b.x), 0, tolerance);
    EXPECT_NEAR(length(a.y - b.y), 0, tolerance);
    EXPECT_NEAR(length(a.z - b.z), 0, tolerance);
}
// A rate is the derivative of the turn.
void expect_rate(Kernels& kernels, double et_s, double tolerance) {
    const FrameTurn now = kernels.turn(et_s), later = kernels.turn(et_s + 10),
                    before = kernels.turn(et_s - 10);
    for (const Vec3d Mat3d::*axis : {&Mat3d::x, &Mat3d::y, &Mat3d::z}) {
        const auto of = [&](const FrameTurn& t) { return transposed(t.reference_from_frame).*axis; };
        EXPECT_NEAR(length(0.05 * (of(later) - of(before)) - cross(now.rate_rad_s, of(now))), 0, tolerance);
    }
}

// NAIF's CSPICE gives this matrix for the frame MRO_MME_OF_DATE of the Mars Reconnaissance Orbiter (SpiceyPy's tests, test_zzdynrot,
// 8 digits). Mars' mean equator of date, as the mission's frames kernel has it by Euler's angles, and by two vectors with Mars' pole of
// the IAU's report of 2009 (pck00010.tpc).
TEST(DynamicFrame, MarsMeanEquatorOfDateIsThatOfCspice) {
    Kernels kernels(
        frame_text("FRAME_5000_FAMILY = 'TWO-VECTOR'\nFRAME_5000_PRI_AXIS = 'Z'\nFRAME_5000_PRI_VECTOR_DEF = "
                   "'CONSTANT'\nFRAME_5000_PRI_FRAME = 'IAU_MARS'\nFRAME_5000_PRI_SPEC = "
                   "'RECTANGULAR'\nFRAME_5000_PRI_VECTOR = "
                   "( 0, 0, 1 )\nFRAME_5000_SEC_AXIS = 'Y'\nFRAME_5000_SEC_VECTOR_DEF = "
                   "'CONSTANT'\nFRAME_5000_SEC_FRAME = "
                   "'J2000'\nFRAME_5000_SEC_SPEC = 'RECTANGULAR'\nFRAME_5000_SEC_VECTOR = ( 0, 0, 1 )\n"
                   "BODY499_POLE_RA = ( 317.68143 -0.1061 0 )\nBODY499_POLE_DEC = ( 52.88650 -0.0609 0 "
                   ")\nBODY499_PM = ( "
                   "176.630 350.89198226 0 )\n"));
    const Mat3d expected = {{0.6733481, -0.5895359, 0.44614992},
                            {0.73932559, 0.53692566, -0.40633546},
                            {0, 0.60345527, 0.79739685}};
    expect_same(kernels.turn(221'051'477.42023).reference_from_frame, expected, 1e-7);
    Kernels euler(frame_text(
        "FRAME_5000_FAMILY = 'EULER'\nFRAME_5000_EPOCH = @2000-JAN-1/12:00:00\nFRAME_5000_AXES = ( 3 1 3 "
        ")\nFRAME_5000_UNITS = 'DEGREES'\nFRAME_5000_ANGLE_1_COEFFS = ( -47.68143 0.33621061170684714e-10 "
        ")\nFRAME_5000_ANGLE_2_COEFFS = ( -37.1135 -0.19298045478743630e-10 )\nFRAME_5000_ANGLE_3_COEFFS = ( "
        "0.0 "
        ")\nFRAME_5000_ROTATION_STATE = 'INERTIAL'\n"));
    expect_same(euler.turn(221'051'477.42023).reference_from_frame, expected, 1e-7);
    EXPECT_LT(length(kernels.turn(0).rate_rad_s), 1e-12);  // the pole's own rate, not Mars' day
}

constexpr const char* kOrbit =
    "FRAME_5000_FAMILY = 'TWO-VECTOR'\nFRAME_5000_PRI_AXIS = '-Z'\nFRAME_5000_PRI_VECTOR_DEF = "
    "'OBSERVER_TARGET_POSITION'\nFRAME_5000_PRI_OBSERVER = -99\nFRAME_5000_PRI_TARGET = "
    "'EARTH'\nFRAME_5000_PRI_ABCORR "
    "= 'NONE'\nFRAME_5000_SEC_AXIS = 'X'\nFRAME_5000_SEC_VECTOR_DEF = 'OBSERVER_TARGET_VELOCITY'\n"
    "FRAME_5000_SEC_OBSERVER = 'EARTH'\nFRAME_5000_SEC_TARGET = -99\nFRAME_5000_SEC_ABCORR = "
    "'NONE'\nFRAME_5000_SEC_FRAME = 'J2000'\n";

// Radial, along and across: on a circle the axes are known, and turn at the orbit's rate about its pole.
TEST(DynamicFrame, AnOrbitsOwnAxesTurnWithIt) {
    Kernels kernels(frame_text(kOrbit));
    for (const double t : {-5e5, 0.0, 1234.5, 9e5}) {
        const FrameTurn turn = kernels.turn(t);
        StateVector s;
        ASSERT_TRUE(kernels.bodies.state(-99, 399, t, s));
        const Vec3d up = normalized(s.position_m), pole = normalized(cross(s.position_m, s.velocity_m_s));
        const Mat3d axes = transposed(turn.reference_from_frame);
        EXPECT_LT(length(axes.z - up), 1e-12);
        EXPECT_LT(length(axes.x - cross(pole, up)), 1e-12);
        EXPECT_LT(length(turn.rate_rad_s - kRate_rad_s * pole), 1e-9);
    }
    // The last instant of the kernel has one side.
    EXPECT_LT(length(kernels.turn(1e6).rate_rad_s) - kRate_rad_s, 1e-6);
    EXPECT_FALSE(kernels.knows(1e6 + 1));
}

// A frozen frame stands as it did; an inertial one moves, and its rate is left out.
TEST(DynamicFrame, FrozenAndInertialFrames) {
    Kernels frozen(frame_text(std::string(kOrbit) + "FRAME_5000_FREEZE_EPOCH = @2000-JAN-1/12:20:34.5\n"));
    Kernels moving(frame_text(kOrbit)),
        inertial(frame_text(std::string(kOrbit) + "FRAME_5000_ROTATION_STATE = 'INERTIAL'\n"));
    const Mat3d then = moving.turn(1234.5).reference_from_frame;
    for (const double t : {0.0, 5e4}) {
        expect_same(frozen.turn(t).reference_from_frame, then, 1e-12);
        EXPECT_EQ(length(frozen.turn(t).rate_rad_s), 0);
        expect_same(inertial.turn(t).reference_from_frame, moving.turn(t).reference_from_frame, 0);
        EXPECT_EQ(length(inertial.turn(t).rate_rad_s), 0);
    }
}

// The example of "Frames Required Reading": angles of a pole and a prime meridian as Euler's give IAU_MARS itself.
TEST(DynamicFrame, EulersAnglesOfAPoleAreItsBodysFrame) {
    // r(t) takes the frame into its base: the transpose of [W]3 [90 - dec]1 [90 + ra]3.
    const std::string text = frame_text(
        "FRAME_5000_FAMILY = 'EULER'\nFRAME_5000_EPOCH = @2000-JAN-1/12:00:00.000\nFRAME_5000_AXES = ( 3 1 3 "
        ")\nFRAME_5000_UNITS = 'DEGREES'\nFRAME_5000_ANGLE_1_COEFFS = ( -47.68143 0.33621061170684714e-10 "
        ")\nFRAME_5000_ANGLE_2_COEFFS = ( -37.1135 -0.19298045478743630e-10 )\nFRAME_5000_ANGLE_3_COEFFS = ( "
        "-176.630 "
        "-0.40612497946759260e-02 )\nBODY499_POLE_RA = ( 317.68143 -0.1061 0 )\nBODY499_POLE_DEC = ( "
        "52.88650 -0.0609 0 "
        ")\nBODY499_PM = ( 176.630 350.89198226 0 )\n");
    Kernels kernels(text);
    const int mars = kernels.frames.require("IAU_MARS", "test");
    for (const double t : {0.0, 1e7, -3e8}) {
        FrameTurn expected;
        ASSERT_TRUE(kernels.frames.turn(mars, t, expected));
        const FrameTurn turn = kernels.turn(t);
        expect_same(turn.reference_from_frame, expected.reference_from_frame, 1e-8);
        EXPECT_LT(length(turn.rate_rad_s - expected.rate_rad_s), 1e-12);
    }
    expect_rate(kernels, 1e6, 1e-9);
}

TEST(DynamicFrame, TheEarthsAxesOfDate) {
    Kernels mean(
        frame_text("FRAME_5000_FAMILY = 'MEAN_EQUATOR_AND_EQUINOX_OF_DATE'\nFRAME_5000_PREC_MODEL = "
                   "'EARTH_IAU_1976'\nFRAME_5000_ROTATION_STATE = 'ROTATING'\n"));
    expect_same(mean.turn(0).reference_from_frame, {}, 1e-12);
    // General precession in longitude and obliquity, 50.29 arcsec a year about the ecliptic's pole (Lieske et al. 1977).
    const Vec3d rate = mean.turn(0).rate_rad_s;
    EXPECT_NEAR(length(rate) * 365.25 * 86400 / kArcsecond_rad, 50.29, 0.02);
    Kernels truly(
        frame_text("FRAME_5000_FAMILY = 'TRUE_EQUATOR_AND_EQUINOX_OF_DATE'\nFRAME_5000_PREC_MODEL = "
                   "'EARTH_IAU_1976'\nFRAME_5000_NUT_MODEL = 'EARTH_IAU_1980'\nFRAME_5000_ROTATION_STATE = "
                   "'INERTIAL'\n"));
    EXPECT_EQ(length(truly.turn(5e8).rate_rad_s), 0);
    Kernels ecliptic(
        frame_text("FRAME_5000_FAMILY = 'MEAN_ECLIPTIC_AND_EQUINOX_OF_DATE'\nFRAME_5000_PREC_MODEL = "
                   "'EARTH_IAU_1976'\nFRAME_5000_OBLIQ_MODEL = 'EARTH_IAU_1980'\nFRAME_5000_ROTATION_STATE = "
                   "'ROTATING'\n"));
    FrameTurn expected;
    ASSERT_TRUE(ecliptic.frames.turn(ecliptic.frames.require("ECLIPJ2000", "test"), 0, expected));
    expect_same(ecliptic.turn(0).reference_from_frame, expected.reference_from_frame, 1e-9);
}

TEST(DynamicFrame, WhatCannotBeReadIsNamed) {
    EXPECT_THAT(frame_refusal(frame_text("")),
                HasSubstr("t.tf:4: frame 'DYN': no kernel has FRAME_5000_FAMILY"));
    EXPECT_THAT(frame_refusal(frame_text("FRAME_5000_FAMILY = 'PRODUCT'\n")),
                HasSubstr("found 'PRODUCT'; accepted: TWO-VECTOR, EULER"));
    EXPECT_THAT(frame_refusal(frame_text(std::string(kOrbit) + "FRAME_5000_PRI_ABCORR = 'LT+S'\n")),
                HasSubstr("FRAME_5000_PRI_ABCORR: found 'LT+S'; accepted: NONE"));
    EXPECT_THAT(frame_refusal(frame_text(std::string(kOrbit) + "FRAME_5000_SEC_AXIS = 'z'\n")),
                HasSubstr("FRAME_5000_SEC_AXIS: is that of the primary vector"));
    EXPECT_THAT(frame_refusal(frame_text(std::string(kOrbit) + "FRAME_5000_PRI_OBSERVER = 'NOBODY'\n")),
                HasSubstr("NOBODY"));
    EXPECT_THAT(frame_refusal(frame_text(
                    "FRAME_5000_FAMILY = 'EULER'\nFRAME_5000_EPOCH = 0\nFRAME_5000_AXES = ( 3 3 1 )\n")),
                HasSubstr("FRAME_5000_AXES: two neighbours are the same"));
    // Vectors that are parallel have no frame; nor have frames and bodies in a circle.
    Kernels parallel(
        frame_text(std::string(kOrbit) + "FRAME_5000_SEC_VECTOR_DEF = 'OBSERVER_TARGET_POSITION'\n"));
    EXPECT_FALSE(parallel.knows(0));
    Kernels circle(frame_text(kOrbit), 5000);
    EXPECT_FALSE(circle.knows(0));
}

}  // namespace
}  // namespace hilcam
