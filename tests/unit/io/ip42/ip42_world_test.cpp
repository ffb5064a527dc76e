#include "io/ip42/ip42_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/ip42/commands_ip42.h"
#include "render/vocabulary/attitude.h"
#include "render/vocabulary/units.h"
#include "tests/support/near.h"

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const TimeTai kTime = parse_utc("2026-03-20T14:00:00Z");
const Quat kQuarterTurn42 = from_rotation_vector({0, 0, kPi / 2});

Ip42BodyConfig moves(const std::string& body, const std::string& thing, std::int64_t joint = 0) {
    Ip42BodyConfig c;
    c.body = body, c.moves = thing, c.joint = joint;
    return c;
}

class Ip42WorldTest : public testing::Test {
  protected:
    Ip42Bench bench{{}, {{"target", {}}, {"winged", {{0, 1, 0}, {0, 0, 2}}}}};
    Ip42World::Rules rules{
        {moves("SC[0].B[0]", "camera"), moves("SC[1].B[0]", "target")}, {}, 0.1 * kDegree_rad, true};
    std::vector<std::string> said;
    FirstRemarks remarks{[this](const std::string& text) { said.push_back(text); }};

    static Ip42Message message() {
        Ip42Message m;
        m.time = kTime;
        m.orbits[0] = {Vec3d{7e6, 0, 0}, Vec3d{0, 7500, 0}};
        m.spacecraft[0].position_r_m = Vec3d{1, 2, 3};
        m.spacecraft[0].velocity_r_m_s = Vec3d{0.1, 0, 0};
        m.spacecraft[0].bodies[0] = {kQuarterTurn42, Vec3d{0, 0, 0.5}};
        m.spacecraft[1].position_r_m = Vec3d{0, 50, 0};
        m.spacecraft[1].velocity_r_m_s = Vec3d{0, 1, 0};
        m.spacecraft[1].bodies[0] = {Quat{}, Vec3d{}};
        return m;
    }
    std::vector<Command> commands(const Ip42Message& m) {
        return Ip42World(rules, bench, remarks).commands_of(m);
    }
    static const PoseCommand& pose(const Command& c) { return std::get<PoseCommand>(c); }
};

TEST_F(Ip42WorldTest, PlacesAreThoseOfTheOrbitPlusTheSpacecrafts) {
    const std::vector<Command> out = commands(message());
    ASSERT_EQ(out.size(), 2u);
    const PoseCommand& eye = pose(out[0]);
    EXPECT_EQ(eye.object, 0);
    EXPECT_TRUE(eye.alone);
    EXPECT_EQ(eye.motion.time, kTime);
    expect_near(eye.motion.pose.position_world_m, {7e6 + 1, 2, 3}, 1e-9);
    expect_near(eye.motion.velocity_world_m_s, {0.1, 7500, 0}, 1e-12);
    expect_near(eye.motion.rate_body_rad_s, {0, 0, 0.5}, 1e-15);
    expect_near(to_matrix(eye.motion.pose.world_from_body) * Vec3d{1, 0, 0}, {0, 1, 0}, 1e-15);
    EXPECT_EQ(pose(out[1]).object, 1);
    expect_near(pose(out[1]).motion.pose.position_world_m, {7e6, 50, 0}, 1e-9);
    EXPECT_THAT(said, IsEmpty());
}

// 42 gives the centre of mass; a thing's origin is elsewhere, and moves when the spacecraft turns.
TEST_F(Ip42WorldTest, AThingStandsAtItsPlaceOnTheSpacecraft) {
    rules.bodies[0].place_m = {2, 0, 0};
    rules.bodies[0].attitude = from_rotation_vector({kPi / 2, 0, 0});  // the thing's y is the body's z
    const std::vector<Command> out = commands(message());
    const Motion& motion = pose(out[0]).motion;
    expect_near(motion.pose.position_world_m, {7e6 + 1, 4, 3}, 1e-9);
    expect_near(motion.velocity_world_m_s, {0.1 - 0.5 * 2, 7500, 0}, 1e-12);
    expect_near(to_matrix(motion.pose.world_from_body) * Vec3d{0, 1, 0}, {0, 0, 1}, 1e-15);
    expect_near(motion.rate_body_rad_s, {0, 0.5, 0}, 1e-15);
}

TEST_F(Ip42WorldTest, OutsideLockstepPosesHoldOnArrival) {
    rules.lockstep = false;
    const std::vector<Command> out = commands(message());
    EXPECT_EQ(pose(out[0]).motion.time.ns, 0);
    EXPECT_FALSE(pose(out[0]).alone);
}

// An origin at a place that turns with the Earth: ICRF axes, another origin and velocity.
TEST_F(Ip42WorldTest, AnOriginThatTurnsIsTakenOff) {
    bench.origin.kind = OriginConfig::Kind::kEarthFixed;
    bench.origin.place = {0.3, 0, 35786e3};
    const Mat3d icrf_from_earth = transposed(earth_fixed_from_icrf(kTime, {}));
    const Vec3d place_m = icrf_from_earth * earth_fixed_position_m(bench.origin.place);
    Ip42Message m = message();
    m.orbits[0].position_n_m = place_m;
    // At rest above the Earth: w x r about the pole of date, w = 7.292115e-5 rad/s (WGS 84).
    m.orbits[0].velocity_n_m_s = cross(7.292115e-5 * (icrf_from_earth * Vec3d{0, 0, 1}), place_m);
    m.spacecraft[1].position_r_m = m.spacecraft[1].velocity_r_m_s = Vec3d{};
    const std::vector<Command> out = commands(m);
    expect_near(pose(out[1]).motion.pose.position_world_m, {}, 1e-6);
    // The velocity of the place is a difference over a minute (bodies.cpp): (w 30 s)^2 / 6 of 3 km/s too small.
    expect_near(pose(out[1]).motion.velocity_world_m_s, {}, 3e-3);
}

// Mars: alpha 317.681 deg, delta 52.887 deg, the pole of 42's World[MARS] (IAU). N's z is the pole, N's x its
// node on ICRF's equator at alpha + 90 deg.
TEST_F(Ip42WorldTest, AtOtherWorldsNHasTheAxesOfTheirPole) {
    const double alpha = 317.681 * kDegree_rad, delta = 52.887 * kDegree_rad;
    const Mat3d icrf_from_n_axes = icrf_from_n({alpha, delta});
    expect_near(icrf_from_n_axes * Vec3d{0, 0, 1},
                {std::cos(delta) * std::cos(alpha), std::cos(delta) * std::sin(alpha), std::sin(delta)},
                1e-15);
    expect_near(icrf_from_n_axes * Vec3d{1, 0, 0}, {-std::sin(alpha), std::cos(alpha), 0}, 1e-15);
    rules.world_from_n = icrf_from_n_axes;
    bench.origin.kind = OriginConfig::Kind::kBodyCenter;
    bench.origin.body = BodyId::kMars;
    const std::vector<Command> out = commands(message());
    expect_near(pose(out[1]).motion.pose.position_world_m, icrf_from_n_axes * Vec3d{7e6, 50, 0}, 1e-8);
    expect_near(pose(out[1]).motion.velocity_world_m_s, icrf_from_n_axes * Vec3d{0, 7501, 0}, 1e-11);
    expect_near(to_matrix(pose(out[1]).motion.pose.world_from_body) * Vec3d{1, 0, 0},
                icrf_from_n_axes * Vec3d{1, 0, 0}, 1e-15);
}

TEST_F(Ip42WorldTest, AJointsAngleIsTheTwistAboutItsAxis) {
    rules.bodies = {moves("SC[1].B[0]", "winged"), moves("SC[1].B[1]", "winged", 1),
                    moves("SC[1].B[2]", "winged", 2)};
    rules.bodies[0].attitude =
        from_rotation_vector({0.3, 0.4, -0.2});  // the mesh has other axes than the body
    const Quat n_from_body = from_rotation_vector({0.1, -2, 0.7});
    const Quat n_from_object = n_from_body * rules.bodies[0].attitude;
    const auto with_angles = [&](double one_rad, double two_rad) {
        Ip42Message m = message();
        Ip42Spacecraft& craft = m.spacecraft[1];
        const Vec3d base_rate{0.01, 0.02, 0.03};
        craft.bodies[0] = {n_from_body, base_rate};
        const Quat one = n_from_object * from_rotation_vector({0, one_rad, 0});
        const Quat two = n_from_object * from_rotation_vector({0, 0, two_rad});
        // The parts' rates in their own axes: the base's, and 0.25 rad/s about the first joint's axis.
        const Vec3d base_object = transposed(to_matrix(rules.bodies[0].attitude)) * base_rate;
        craft.bodies[1] = {one, transposed(to_matrix(from_rotation_vector({0, one_rad, 0}))) *
                                    (base_object + Vec3d{0, 0.25, 0})};
        // 42 may write either sign.
        craft.bodies[2] = {Quat{-two.w, -two.x, -two.y, -two.z}, {}};
        return m;
    };
    Ip42World world(rules, bench, remarks);
    for (const double angle : {0.0, 0.5, 3.0, 3.3, 6.4, 6.2}) {
        const std::vector<Command> out = world.commands_of(with_angles(angle, -0.5 * angle));
        ASSERT_EQ(out.size(), 3u);
        const auto& one = std::get<JointCommand>(out[1]);
        const auto& two = std::get<JointCommand>(out[2]);
        EXPECT_EQ(one.object, 2);
        EXPECT_EQ(one.joint, 1);
        EXPECT_EQ(one.time, kTime);
        // Through half a turn and beyond: the angle goes on.
        EXPECT_NEAR(one.angle_rad, angle, 1e-14);
        EXPECT_NEAR(one.rate_rad_s, 0.25, 1e-14);
        EXPECT_NEAR(two.angle_rad, -0.5 * angle, 1e-14);
    }
    EXPECT_THAT(said, IsEmpty());
    world.restart();
    const std::vector<Command> again = world.commands_of(with_angles(6.4, 0));
    EXPECT_NEAR(std::get<JointCommand>(again[1]).angle_rad, 6.4 - 2 * kPi, 1e-14);
    // A part that turns about another axis is named.
    Ip42Message m = with_angles(0.5, 0);
    m.spacecraft[1].bodies[1].n_from_body = n_from_object * from_rotation_vector({0.01, 0, 0});
    world.commands_of(m);
    EXPECT_THAT(said,
                ElementsAre(HasSubstr("SC[1].B[1]: it is 0.573 deg off a turn about the axis of joint 1")));
}

TEST_F(Ip42WorldTest, WhatAMessageLacksIsNamedOnceAndMovesNothing) {
    Ip42World world(rules, bench, remarks);
    Ip42Message m = message();
    m.orbits.clear();
    EXPECT_THAT(world.commands_of(m), IsEmpty());
    EXPECT_THAT(world.commands_of(m), IsEmpty());
    m = message();
    m.spacecraft[1].position_r_m.reset();
    EXPECT_EQ(world.commands_of(m).size(), 1u);
    m = message();
    m.spacecraft[0].bodies.clear();
    EXPECT_EQ(world.commands_of(m).size(), 1u);
    m = message();
    m.spacecraft[0].position_r_m = Vec3d{1e16, 0, 0};
    EXPECT_EQ(world.commands_of(m).size(), 1u);
    EXPECT_THAT(
        said, ElementsAre(HasSubstr("no Orb[0].PosN"), HasSubstr("no SC[1].PosR"),
                          HasSubstr("no SC[0].B[0].qn"), HasSubstr("SC[0].B[0]: a place 1.000000001e+16 m")));
}

TEST_F(Ip42WorldTest, ASunElsewhereIsNamed) {
    Ip42World world(rules, bench, remarks);
    Ip42Message m = message();
    const Vec3d sun_dir = normalized(sun_from_earth_m(kTime) - Vec3d{7e6, 0, 0});
    m.spacecraft[1].sun_body_dir = sun_dir;  // SC[1] has N's axes
    world.commands_of(m);
    EXPECT_THAT(said, IsEmpty());  // aberration is 20 arcsec
    m.spacecraft[1].sun_body_dir = to_matrix(from_rotation_vector({0, 0, 0.01})) * sun_dir;
    world.commands_of(m);
    EXPECT_THAT(said, ElementsAre(HasSubstr("SC[1].svb: 42 has the Sun 0.5")));
}

TEST_F(Ip42WorldTest, BodiesThatMoveNothingAreRefused) {
    const auto refusal = [&](std::vector<Ip42BodyConfig> bodies) {
        try {
            check_bodies(bodies, bench);
        } catch (const KeyError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(refusal(rules.bodies), "");
    EXPECT_EQ(refusal({moves("SC[0].B[0]", "nobody")}),
              "bodies.0.moves: found 'nobody'; accepted: camera, target, winged");
    EXPECT_THAT(refusal({moves("SC[0].B[0]", "target"), moves("SC[1].B[0]", "target")}),
                HasSubstr("another thing, as SC[0].B[0] moves this one"));
    EXPECT_THAT(refusal({moves("SC[0].B[0]", "target", 1)}), HasSubstr("'target' has no joints"));
    EXPECT_THAT(refusal({moves("SC[0].B[0]", "winged"), moves("SC[0].B[1]", "winged", 3)}),
                HasSubstr("bodies.1.joint: found 3; accepted: 0 to 2"));
    EXPECT_THAT(refusal({moves("SC[0].B[1]", "winged", 1)}), HasSubstr("needs a body that moves 'winged'"));
    EXPECT_THAT(refusal({moves("SC[0].B[0]", "camera", 1)}), HasSubstr("'camera' has no joints"));
}

TEST(Ip42Remarks, AreBoundedInNumber) {
    std::vector<std::string> said;
    FirstRemarks remarks([&](const std::string& text) { said.push_back(text); });
    for (int i = 0; i < 300; ++i) remarks.remark("topic " + std::to_string(i), "text");
    EXPECT_EQ(said.size(), FirstRemarks::kMost);
    EXPECT_EQ(said.back(), "more remarks than these are not shown");
}

}  // namespace
}  // namespace hilcam
