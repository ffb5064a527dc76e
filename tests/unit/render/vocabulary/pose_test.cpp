#include <gtest/gtest.h>

#include "render/vocabulary/check.h"
#include "render/vocabulary/pose.h"
#include "render/vocabulary/units.h"
#include "tests/support/near.h"

namespace hilcam {
namespace {

TEST(Quaternion, QuarterTurnAboutZTakesXToY) {
    const Quat q = from_rotation_vector({0, 0, kPi / 2});
    expect_near(to_matrix(q) * Vec3d{1, 0, 0}, {0, 1, 0}, 1e-15);
}

TEST(Quaternion, MatrixAndBackIsTheSameForEveryLargestComponent) {
    for (const Vec3d v : {Vec3d{0.1, 0.2, 0.3}, Vec3d{3.1, 0, 0}, Vec3d{0, 3.1, 0.2}, Vec3d{0.1, 0.1, 3.1}}) {
        const Quat q = from_rotation_vector(v);
        const Quat r = to_quat(to_matrix(q));
        EXPECT_NEAR(std::abs(q.w * r.w + q.x * r.x + q.y * r.y + q.z * r.z), 1, 1e-14);
    }
}

TEST(Quaternion, TinyRotationKeepsItsDigits) {
    const Quat q = from_rotation_vector({1e-9, 0, 0});
    EXPECT_NEAR(q.x / 0.5e-9, 1, 1e-12);
}

TEST(Quaternion, SlerpHalfwayOfQuarterTurnIsEighthTurn) {
    const Quat half = slerp({1, 0, 0, 0}, from_rotation_vector({0, 0, kPi / 2}), 0.5);
    EXPECT_NEAR(half.z, std::sin(kPi / 8), 1e-15);
}

TEST(Pose, PropagationIsExactForConstantRates) {
    Motion m;
    m.velocity_world_m_s = {1, 2, 3};
    m.rate_body_rad_s = {0, 0, kPi};
    const Pose p = propagate(m, TimeTai{500'000'000});
    expect_near(p.position_world_m, {0.5, 1, 1.5}, 1e-12);
    expect_near(to_matrix(p.world_from_body) * Vec3d{1, 0, 0}, {0, 1, 0}, 1e-12);
}

TEST(Pose, InterpolationOfACubicIsTheCubic) {
    // x = t^3 with its derivative at both ends: a cubic Hermite is exact.
    Motion a, b;
    b.time = TimeTai{2'000'000'000};
    b.pose.position_world_m = {8, 0, 0};
    b.velocity_world_m_s = {12, 0, 0};
    EXPECT_NEAR(interpolate(a, b, TimeTai{1'000'000'000}).position_world_m.x, 1.0, 1e-12);
    EXPECT_NEAR(interpolate(a, b, TimeTai{9'000'000'000}).position_world_m.x, 8.0, 1e-12);
}

TEST(Pose, LookAlongPointsTheBoresightAndKeepsUpUp) {
    const Mat3d m = to_matrix(look_along({0, 1, 0}, {0, 0, 1}));
    expect_near(m * Vec3d{0, 0, 1}, {0, 1, 0}, 1e-15);
    expect_near(m * Vec3d{0, 1, 0}, {0, 0, -1}, 1e-15);
    EXPECT_THROW(look_along({0, 0, 2}, {0, 0, 1}), InputError);
}

}  // namespace
}  // namespace hilcam
