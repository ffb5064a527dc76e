#include "render/vocabulary/attitude.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"
#include "tests/support/near.h"

namespace hilcam {
namespace {

void expect_same(Quat a, Quat b, double tolerance) {
    const double sign = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z < 0 ? -1 : 1;
    EXPECT_NEAR(a.w, sign * b.w, tolerance);
    expect_near(Vec3d{a.x, a.y, a.z}, sign * Vec3d{b.x, b.y, b.z}, tolerance);
}

// What Basilisk's own test of its rigid-body kinematics (rigidBodyKinematics.c) expects of the MRP (0.2,
// -0.25, 0.3): Euler parameters, [BN] and the angles of all twelve sequences [rad].
constexpr Vec3d kSigma{0.2, -0.25, 0.3};
constexpr Quat kParameters{0.6771488469601677, 0.3354297693920336, -0.419287211740042, 0.5031446540880503};
constexpr Mat3d kMatrix{{0.1420873822677549, 0.4001248192538094, 0.9053790945330048},
                        {-0.9626904702257736, 0.2686646537364468, 0.03234752493088797},
                        {-0.2303003133666478, -0.876196001388834, 0.4233702077537369}};
constexpr std::array<Vec3d, 12> kAngles = {{
    {2.725460144813494, 1.428226451915784, -1.805609061169705},
    {1.120685944613971, -0.2323862804943196, 1.424260216144192},
    {1.154663818018597, 1.428226451915784, -0.2348127343748092},
    {0.1198243320629901, 1.296774918090265, -1.017995395279125},
    {-1.537207795170527, 1.298789879764913, 0.4283796513241308},
    {-0.4982011776145131, 1.067911809027856, 0.979488037955722},
    {-1.415129132201094, 0.4116530390866675, 1.273271587093173},
    {0.03358853162436948, 1.298789879764913, -1.142416675470766},
    {1.298643836753137, 0.03235316879424937, -1.133389474325039},
    {-0.257027406977469, 1.133634172515794, 1.535083362165219},
    {1.22957853325386, -1.13227169191098, 0.0762566635156139},
    {-1.827823733772366, 1.133634172515794, 3.105879688960115},
}};

// The program's quaternion turns body axes into the frame's: its numbers are the passive Euler parameters of
// the body against the frame, and its matrix is [BN] transposed.
TEST(Attitude, IsBasilisksInEveryForm) {
    expect_same(from_mrp(kSigma), kParameters, 1e-14);
    expect_near(mrp_of(kParameters), kSigma, 1e-14);
    expect_same(from_dcm(kMatrix), kParameters, 1e-14);
    const Mat3d frame_from_body = to_matrix(kParameters);
    expect_near(frame_from_body * Vec3d{1, 0, 0}, kMatrix.x, 1e-14);
    for (std::size_t i = 0; i < kEulerSequences.size(); ++i) {
        SCOPED_TRACE(kEulerSequences[i]);
        expect_same(from_euler(euler_axes(i), kAngles[i]), kParameters, 1e-13);
    }
}

// Schaub & Junkins, Analytical Mechanics of Space Systems, 2018, section 3.7: [BN] of an MRP, for turns of up
// to 270 deg.
TEST(Attitude, MrpsAreThoseOfThePublishedMatrix) {
    for (const Vec3d s : {Vec3d{0.1, 0.7, -0.2}, Vec3d{-2, 1, 0.5}, Vec3d{0, 0, 1}, Vec3d{}}) {
        const double square = dot(s, s), below = (1 + square) * (1 + square);
        const auto times = [&](Vec3d v) {
            const Vec3d once = cross(s, v);
            return v + (8.0 * cross(s, once) - 4 * (1 - square) * once) / below;
        };
        const Mat3d body_from_frame = transposed(to_matrix(from_mrp(s)));
        for (const Vec3d v : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
            expect_near(body_from_frame * v, times(v), 1e-14);
    }
    EXPECT_LE(length(mrp_of(from_mrp({-2, 1, 0.5}))), 1) << "the short way";
}

TEST(Attitude, AMatrixIsJudgedByItsWorstEntry) {
    EXPECT_LT(rotation_error(kMatrix), 1e-14);
    Mat3d off = kMatrix;
    off.x = (1 + 5e-5) * off.x;
    EXPECT_NEAR(rotation_error(off), 1e-4, 1e-8);
    // The nearest rotation: what is stretched along an axis is not turned.
    expect_same(from_dcm(off), kParameters, 1e-12);
    EXPECT_GE(rotation_error({{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), 2) << "a mirror";
    EXPECT_GE(rotation_error({{1, 0, 0}, {1, 0, 0}, {0, 0, 1}}), 1);
}

// What is 0.36 arcsec up in the picture from the boresight lies at the position angle `roll` from it:
// astropy 5.2, SkyCoord.directional_offset_by.
TEST(Attitude, RollIsThePositionAngleOfUp) {
    const Mat3d m = to_matrix(from_radec({83.8221 * kDegree_rad, -5.3911 * kDegree_rad, 30 * kDegree_rad}));
    expect_near(-(m * Vec3d{0, 1, 0}), {-0.488340064716, 0.134700811221, 0.862194683729}, 2e-6);
    // North up has east on the left.
    const Mat3d north_up = to_matrix(from_radec({}));
    expect_near(north_up * Vec3d{-1, 0, 0}, {0, 1, 0}, 1e-15);
    expect_near(north_up * Vec3d{0, -1, 0}, {0, 0, 1}, 1e-15);
    expect_near(north_up * Vec3d{0, 0, 1}, {1, 0, 0}, 1e-15);
}

TEST(Attitude, RaDecRollAndBack) {
    for (const double dec_deg : {-89.9, -30.0, 0.0, 60.0})
        for (const double ra_deg : {0.0, 80.0, 200.0, 359.0})
            for (const double roll_deg : {0.0, 100.0, 260.0}) {
                const RaDecRoll back = radec_of(
                    from_radec({ra_deg * kDegree_rad, dec_deg * kDegree_rad, roll_deg * kDegree_rad}));
                EXPECT_NEAR(std::remainder(back.right_ascension_rad / kDegree_rad - ra_deg, 360), 0, 1e-9);
                EXPECT_NEAR(back.declination_rad / kDegree_rad, dec_deg, 1e-9);
                EXPECT_NEAR(std::remainder(back.roll_rad / kDegree_rad - roll_deg, 360), 0, 1e-9);
            }
    // At the pole right ascension and roll are one angle.
    const Quat pole = from_radec({0.7, 0.5 * kPi, 0.4});
    expect_same(from_radec(radec_of(pole)), pole, 1e-12);
}

// The worked example of docs/conventions.md, its digits as they stand there.
TEST(Attitude, TheWorkedExampleIsOneAttitude) {
    const Quat example = from_radec({60 * kDegree_rad, 30 * kDegree_rad, 20 * kDegree_rad});
    expect_same(example, {0.7848856, -0.4980973, 0.0435779, -0.3659982}, 1e-7);
    expect_same(example, from_mrp({-0.2790640, 0.0244149, -0.2050541}), 1e-7);
    expect_same(example,
                from_dcm({{0.7282926, -0.6179454, 0.2961981},
                          {0.5311213, 0.2358888, -0.8137977},
                          {0.4330127, 0.7500000, 0.5000000}}),
                1e-7);
    const auto yaw_pitch_roll = std::find(kEulerSequences.begin(), kEulerSequences.end(), std::string("321"));
    const auto axes = euler_axes(static_cast<std::size_t>(yaw_pitch_roll - kEulerSequences.begin()));
    expect_same(example, from_euler(axes, kDegree_rad * Vec3d{-40.314105, -17.229397, -58.433296}), 1e-7);
}

}  // namespace
}  // namespace hilcam
