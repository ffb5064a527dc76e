#include "io/vizard/vizard_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/units.h"
#include "tests/support/near.h"

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const TimeTai kEpoch = parse_utc("2026-03-20T14:00:00Z");
const Quat kQuarterAboutZ = from_rotation_vector({0, 0, kPi / 2});

class VizardWorldTest : public testing::Test {
  protected:
    VizardBench bench{kEpoch + 77, {}, {"target"}, {{{}, 0.4, 256, 192}}};
    VizardWorld::Rules rules{VizardTime::kMessage, 0.1 * kDegree_rad, {}};
    std::vector<std::string> remarks;

    VizardWorld world() {
        return VizardWorld(rules, bench, [this](const std::string& text) { remarks.push_back(text); });
    }
    // A camera along the spacecraft's x (its own +z), 1 m before it, 20 km from the target.
    static VizardUpdate update() {
        VizardUpdate u;
        u.frame_number = 5;
        u.elapsed_ns = 3'000'000'000;
        u.epoch = kEpoch;
        u.bodies = {{"earth", {100, 200, 300}, {1, 2, 3}, {}}};
        u.spacecraft = {{"eye", {7e6, 0, 0}, {0, 7500, 0}, kQuarterAboutZ},
                        {"target", {7e6, 20e3, 0}, {0, 7501, 0}, Quat{}}};
        u.cameras = {{1, "eye", {1, 0, 0}, from_rotation_vector({0, kPi / 2, 0}), 0.4, 256, 192, false}};
        return u;
    }
};

TEST_F(VizardWorldTest, CameraAndObjectsStandWhereTheMessageHasThemAboutTheCentralBody) {
    VizardWorld w = world();
    w.take(update());
    VizardShot shot;
    ASSERT_TRUE(w.shot(1, shot));
    EXPECT_EQ(shot.camera, 1);
    EXPECT_EQ(shot.time, kEpoch + 3'000'000'000);
    ASSERT_EQ(shot.poses.size(), 2u);
    const Motion& eye = shot.poses[0].motion;
    EXPECT_EQ(shot.poses[0].object, 0);
    EXPECT_TRUE(shot.poses[0].alone);
    EXPECT_EQ(eye.time, shot.time);
    // Its x is N's y; the camera is 1 m along it and looks that way, its own x down N's -z.
    expect_near(eye.pose.position_world_m, {7e6 - 100, 1 - 200, -300}, 1e-8);
    expect_near(eye.velocity_world_m_s, {-1, 7498, -3}, 1e-12);
    expect_near(eye.rate_body_rad_s, {}, 0);
    const Mat3d world_from_camera = to_matrix(eye.pose.world_from_body);
    expect_near(world_from_camera * Vec3d{0, 0, 1}, {0, 1, 0}, 1e-15);
    expect_near(world_from_camera * Vec3d{1, 0, 0}, {0, 0, -1}, 1e-15);
    const PoseCommand& target = shot.poses[1];
    EXPECT_EQ(target.object, 1);
    EXPECT_TRUE(target.alone);
    expect_near(target.motion.pose.position_world_m, {7e6 - 100, 20e3 - 200, -300}, 1e-8);
    expect_near(target.motion.velocity_world_m_s, {-1, 7499, -3}, 1e-12);
    EXPECT_THAT(remarks, IsEmpty());
}

TEST_F(VizardWorldTest, AMountOfTheScenarioIsUndone) {
    const Quat mounted = from_rotation_vector({0.3, -0.2, 0.9});
    bench.cameras[0].body_from_camera = {{0.5, -2, 3}, mounted};
    VizardWorld w = world();
    w.take(update());
    VizardShot shot;
    ASSERT_TRUE(w.shot(1, shot));
    const Pose& body = shot.poses[0].motion.pose;
    const Mat3d world_from_body = to_matrix(body.world_from_body);
    // As WorldState puts the camera on its body.
    expect_near(body.position_world_m + world_from_body * Vec3d{0.5, -2, 3}, {7e6 - 100, 1 - 200, -300},
                1e-8);
    expect_near(to_matrix(body.world_from_body * mounted) * Vec3d{0, 0, 1}, {0, 1, 0}, 1e-15);
}

// A place on the Earth's equator is the origin: the world's axes stay, its origin turns with the Earth.
TEST_F(VizardWorldTest, AnOriginThatTurnsIsTakenOffInPlaceAndVelocity) {
    bench.origin.kind = OriginConfig::Kind::kEarthFixed;
    bench.origin.place = {0.3, 0, 35786e3};
    VizardUpdate u = update();
    const TimeTai time = kEpoch + u.elapsed_ns;
    const Vec3d place_m =
        transposed(earth_fixed_from_icrf(time, {})) * earth_fixed_position_m(bench.origin.place);
    // At rest above the Earth: at the origin, at the Earth's velocity plus w x r, w = 7.292115e-5 rad/s (WGS
    // 84) about the pole of date.
    const Vec3d pole = transposed(earth_fixed_from_icrf(time, {})) * Vec3d{0, 0, 1};
    u.spacecraft[1].position_n_m = u.bodies[0].position_n_m + place_m;
    u.spacecraft[1].velocity_n_m_s = u.bodies[0].velocity_n_m_s + cross(7.292115e-5 * pole, place_m);
    VizardWorld w = world();
    w.take(u);
    VizardShot shot;
    ASSERT_TRUE(w.shot(1, shot));
    expect_near(shot.poses[1].motion.pose.position_world_m, {}, 1e-6);
    expect_near(shot.poses[1].motion.velocity_world_m_s, {}, 1e-3);
}

TEST_F(VizardWorldTest, InFreeSpaceTheMessagesFrameIsTheWorld) {
    bench.origin.kind = OriginConfig::Kind::kFree;
    bench.origin.sun_m = {0, kAstronomicalUnit_m, 0};
    const VizardUpdate u = update();
    VizardWorld w = world();
    w.take(u);
    VizardShot shot;
    ASSERT_TRUE(w.shot(1, shot));
    expect_near(shot.poses[1].motion.pose.position_world_m, u.spacecraft[1].position_n_m, 0);
}

TEST_F(VizardWorldTest, BodiesOfTheScenariosNamesAreObjectsToo) {
    bench.objects = {"bennu"};
    VizardUpdate u = update();
    u.spacecraft.pop_back();
    u.bodies.push_back({"bennu", {1e11, 5, 6}, {}, kQuarterAboutZ});
    VizardWorld w = world();
    w.take(u);
    VizardShot shot;
    ASSERT_TRUE(w.shot(1, shot));
    ASSERT_EQ(shot.poses.size(), 2u);
    expect_near(shot.poses[1].motion.pose.position_world_m, {1e11 - 100, -195, -294}, 1e-4);
    expect_near(to_matrix(shot.poses[1].motion.pose.world_from_body) * Vec3d{1, 0, 0}, {0, 1, 0}, 1e-15);
    EXPECT_THAT(remarks, IsEmpty());
}

TEST_F(VizardWorldTest, CamerasGoByTheirOrderOrByTheScenariosList) {
    bench.cameras.push_back({{}, 0.4, 256, 192});
    VizardUpdate u = update();
    u.cameras.push_back(u.cameras[0]);
    u.cameras.push_back(u.cameras[0]);
    u.cameras[1].id = 7, u.cameras[2].id = 9;
    {
        VizardWorld w = world();
        w.take(u);
        VizardShot shot;
        ASSERT_TRUE(w.shot(7, shot));
        EXPECT_EQ(shot.camera, 2);
        EXPECT_FALSE(w.shot(9, shot));
        EXPECT_FALSE(w.shot(9, shot));
        EXPECT_THAT(remarks, ElementsAre(HasSubstr("camera 9: no picture, as no camera of the scenario")));
    }
    rules.cameras = {{9, 1}};
    VizardWorld w = world();
    w.take(u);
    VizardShot shot;
    ASSERT_TRUE(w.shot(9, shot));
    EXPECT_EQ(shot.camera, 1);
    EXPECT_FALSE(w.shot(7, shot));
}

TEST_F(VizardWorldTest, WhatIsMissingIsNamedOnceInARun) {
    VizardWorld w = world();
    VizardShot shot;
    EXPECT_FALSE(w.shot(1, shot));
    VizardUpdate u = update();
    u.bodies.clear();
    u.cameras[0].width_px = 512;
    u.cameras[0].field_of_view_rad = 0.5;
    u.spacecraft[1].name = "other";
    for (int i = 0; i < 3; ++i) {
        w.take(u);
        u.epoch.reset();
        EXPECT_TRUE(w.shot(1, shot));
    }
    EXPECT_THAT(
        remarks,
        ElementsAre(
            HasSubstr("no picture before a SIM_UPDATE"),
            "camera 1: the simulation's picture is 512 x 192 px, the scenario's camera gives 256 x 192",
            HasSubstr("field of view is 28.648 deg from edge to edge along the columns, the "
                      "scenario's camera has 22.918 deg"),
            HasSubstr("no body 'earth'"), "spacecraft 'other' is not shown, as no object has its name",
            "object 1 'target' stays where it is, as SIM_UPDATE does not name it"));
    remarks.clear();
    u.cameras[0].parent = "nobody";
    u.cameras[0].wants_depth = false;
    w.take(u);
    EXPECT_FALSE(w.shot(1, shot));
    u.cameras[0].wants_depth = true;
    w.take(u);
    EXPECT_FALSE(w.shot(1, shot));
    EXPECT_FALSE(w.shot(2, shot));
    EXPECT_THAT(remarks,
                ElementsAre("camera 1: no picture, as SIM_UPDATE has no spacecraft 'nobody'",
                            HasSubstr("asks for depth"), HasSubstr("SIM_UPDATE has no such camera")));
    // An epoch alone is no new run, as scripts may send it every step; the next run is told again.
    u.epoch = kEpoch;
    w.take(u);
    EXPECT_FALSE(w.shot(1, shot));
    EXPECT_EQ(remarks.size(), 3u);
    u.elapsed_ns = 1;
    w.take(u);
    EXPECT_FALSE(w.shot(1, shot));
    EXPECT_EQ(remarks.size(), 4u);
}

TEST_F(VizardWorldTest, AnAttitudeThatIsMissingIsNamed) {
    VizardUpdate u = update();
    u.spacecraft[1].n_from_body.reset();
    VizardWorld w = world();
    w.take(u);
    VizardShot shot;
    ASSERT_TRUE(w.shot(1, shot));
    expect_near(to_matrix(shot.poses[1].motion.pose.world_from_body) * Vec3d{1, 0, 0}, {1, 0, 0}, 0);
    EXPECT_THAT(remarks, ElementsAre(HasSubstr("no attitude of 'target'")));
}

TEST_F(VizardWorldTest, AConstellationThatIsNotShownLeavesRoomForOtherRemarks) {
    VizardUpdate u = update();
    for (int i = 0; i < 500; ++i) u.spacecraft.push_back({std::to_string(i), {7e6, 0, 0}, {}, Quat{}});
    VizardWorld w = world();
    VizardShot shot;
    for (int i = 0; i < 3; ++i) {
        w.take(u);
        ASSERT_TRUE(w.shot(1, shot));
    }
    ASSERT_EQ(remarks.size(), 11u);
    EXPECT_EQ(remarks[9], "spacecraft '9' is not shown, as no object has its name");
    EXPECT_THAT(remarks[10], HasSubstr("490 more spacecraft and bodies are not shown"));
}

TEST_F(VizardWorldTest, AFloodOfRemarksEnds) {
    VizardWorld w = world();
    for (int run = 0; run < 30; ++run) {
        VizardUpdate u = update();
        u.elapsed_ns = 1'000'000 - run;
        w.take(u);
        for (int i = 0; i < 200; ++i) w.remark(std::to_string(i));
        EXPECT_EQ(remarks.size(), run < 10 ? 101u * static_cast<unsigned>(run + 1) : 1010u) << run;
    }
    EXPECT_EQ(remarks.back(), "more remarks than these are not shown");
}

TEST_F(VizardWorldTest, TimeIsTheMessagesOrTheScenarios) {
    VizardUpdate u = update();
    VizardShot shot;
    {
        VizardWorld w = world();
        u.epoch.reset();
        w.take(u);
        ASSERT_TRUE(w.shot(1, shot));
        EXPECT_EQ(shot.time, bench.start + u.elapsed_ns);
        EXPECT_THAT(remarks, ElementsAre(HasSubstr("no message had an epoch")));
    }
    rules.time = VizardTime::kScenario;
    VizardWorld w = world();
    w.take(update());
    ASSERT_TRUE(w.shot(1, shot));
    EXPECT_EQ(shot.time, bench.start + u.elapsed_ns);
    EXPECT_EQ(remarks.size(), 1u);
}

TEST_F(VizardWorldTest, BodiesElsewhereThanTheEphemeridesHaveThemAreRemarkedOn) {
    VizardUpdate u = update();
    const TimeTai time = kEpoch + u.elapsed_ns;
    const Bodies bodies = bodies_at(time, {});
    const Vec3d earth_m = u.bodies[0].position_n_m;
    const auto body = [&](const std::string& name, Vec3d world_m) {
        return VizardThing{name, earth_m + world_m, {}, {}};
    };
    u.bodies[0].n_from_body = to_quat(transposed(bodies.earth().fixed_from_world));
    u.bodies.push_back(body("sun", bodies.sun_world_m));
    u.bodies.push_back(body("mars barycenter", bodies[BodyId::kMars].world_m));
    VizardShot shot;
    {
        VizardWorld w = world();
        w.take(u);
        ASSERT_TRUE(w.shot(1, shot));
        EXPECT_THAT(remarks, IsEmpty());
    }
    // Turned and moved by twice the tolerance.
    const Quat aside = from_rotation_vector({0, 0, 0.2 * kDegree_rad});
    u.bodies[0].n_from_body = aside * *u.bodies[0].n_from_body;
    u.bodies[1].position_n_m = earth_m + to_matrix(aside) * bodies.sun_world_m;
    VizardWorld w = world();
    w.take(u);
    ASSERT_TRUE(w.shot(1, shot));
    ASSERT_EQ(remarks.size(), 2u);
    EXPECT_THAT(remarks[0], HasSubstr("body 'earth': the simulation turns it 0.2 deg"));
    // The Sun's declination takes the cosine: none within 0.1 deg of the equinox.
    EXPECT_THAT(remarks[1], HasSubstr("body 'sun': the simulation has it 0.2 deg"));
}

}  // namespace
}  // namespace hilcam
