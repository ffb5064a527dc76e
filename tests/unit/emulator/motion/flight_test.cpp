#include <gtest/gtest.h>

#include <cmath>

#include "emulator/motion/flight.h"

namespace hilcam {
namespace {

TEST(CircleFlight, RatesAreTheDerivativesOfThePose) {
    CircleFlight flight;
    flight.center_m = {1, 2, 3};
    flight.start_m = {1, -30, 10};
    flight.up = {0, 0, 1};
    const Motion m = flight.at(7, {});
    constexpr double h = 1e-4;
    const Motion later = flight.at(7 + h, {});
    const Pose predicted =
        propagate({{0}, m.pose, m.velocity_world_m_s, m.rate_body_rad_s}, TimeTai{100'000});
    EXPECT_LT(length(predicted.position_world_m - later.pose.position_world_m), 1e-8);
    const Quat a = predicted.world_from_body, b = later.pose.world_from_body;
    EXPECT_NEAR(std::abs(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z), 1, 1e-12);
    // It looks at the centre all the way.
    const Vec3d boresight = to_matrix(m.pose.world_from_body) * Vec3d{0, 0, 1};
    EXPECT_NEAR(dot(boresight, normalized(flight.center_m - m.pose.position_world_m)), 1, 1e-12);
}

}  // namespace
}  // namespace hilcam
