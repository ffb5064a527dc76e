#include <gtest/gtest.h>

#include <cmath>

#include "emulator/world/world_state.h"
#include "render/vocabulary/units.h"
#include "tests/support/world_at.h"

namespace hilcam {
namespace {

TEST(WorldState, PropagatesInterpolatesAndTakesAnyOrder) {
    const Motion initial = motion_at(0, 5, 1);
    WorldState world(std::span(&initial, 1), {});
    EXPECT_NEAR(camera_x_m(world, 2'000'000'000), 7, 1e-12);  // the scenario's own motion
    world.set(0, motion_at(1'000'000'000, 10, 10), {1, 100});
    EXPECT_NEAR(camera_x_m(world, 1'500'000'000), 15, 1e-12);  // propagated
    world.set(0, motion_at(3'000'000'000, 30, 10), {2, 200});
    world.set(0, motion_at(2'000'000'000, 20, 10), {3, 300});  // late, but between
    EXPECT_NEAR(camera_x_m(world, 2'500'000'000), 25, 1e-9);
    EXPECT_NEAR(camera_x_m(world, 500'000'000), 5, 1e-9);  // backwards from the first command
}

// At a quarter of the way from rest to rest: 3/16 - 2/64 of it by the cubic, a quarter of the turn by slerp.
TEST(WorldState, BetweenTwoTagsPlacesAndAnglesAreCubicAndAttitudesSlerp) {
    const Motion initial[2] = {motion_at(0, 0), motion_at(0, 0)};
    const Joint joint{0, {0, 0, 0}, {0, 0, 1}, 0, 0};
    WorldState world(initial, {}, std::span(&joint, 1));
    const std::int64_t from_ns = 1'000'000'000, to_ns = 3'000'000'000;
    Motion end = motion_at(to_ns, 8);
    end.pose.world_from_body = from_rotation_vector({0, 0, kPi / 2});
    ASSERT_TRUE(world.set(0, motion_at(from_ns, 0), {1, 1}));
    ASSERT_TRUE(world.set(0, end, {2, 2}));
    ASSERT_TRUE(world.set_joint(1, 1, {{from_ns}, 0, 0}, {3, 3}));
    ASSERT_TRUE(world.set_joint(1, 1, {{to_ns}, 0.8, 0}, {4, 4}));
    WorldSnapshot snapshot;
    snapshot.objects.resize(world.placed_objects());
    ShownCommand shown;
    world.sample({1'500'000'000}, snapshot, shown);
    constexpr double kShare = 3.0 / 16 - 2.0 / 64;
    EXPECT_NEAR(snapshot.camera.position_world_m.x, 8 * kShare, 1e-12);
    const auto turned_about_z = [](const Quat& q) { return 2 * std::atan2(q.z, q.w); };
    EXPECT_NEAR(turned_about_z(snapshot.camera.world_from_body), kPi / 8, 1e-12);
    EXPECT_NEAR(turned_about_z(snapshot.objects[1].world_from_body), 0.8 * kShare, 1e-12);
    // The velocities at both tags count as well.
    WorldState moving(std::span(initial, 1), {});
    moving.set(0, motion_at(from_ns, 0, 1), {1, 1});
    moving.set(0, motion_at(to_ns, 8, 1), {2, 2});
    EXPECT_NEAR(camera_x_m(moving, 1'500'000'000), 8 * kShare + 2 * (9.0 / 64 - 3.0 / 64), 1e-12);
}

TEST(WorldState, APoseWithAKnownTagReplacesTheOneThatHadIt) {
    const Motion initial = motion_at(0, 0);
    WorldState world(std::span(&initial, 1), {});
    for (int i = 1; i <= 8; ++i) world.set(0, motion_at(i * 1'000'000'000LL, i, 1), {1, 1});
    world.set(0, motion_at(5'000'000'000, 50), {2, 2});
    EXPECT_EQ(camera_x_m(world, 5'000'000'000), 50);
    EXPECT_NEAR(camera_x_m(world, 1'500'000'000), 1.5, 1e-9) << "the oldest of the eight is still there";
    EXPECT_NEAR(camera_x_m(world, 8'000'000'000), 8, 1e-9);
}

TEST(WorldState, TellsTheNewestCommandItShows) {
    const Motion initial[2] = {motion_at(0, 0), motion_at(0, 0)};
    WorldState world(initial, {});
    world.set(1, motion_at(5, 1), {7, 900});
    world.set(0, motion_at(5, 1), {6, 800});
    WorldSnapshot snapshot;
    snapshot.objects.resize(1);
    ShownCommand shown;
    world.sample({5}, snapshot, shown);
    EXPECT_EQ(shown.sequence, 7u);
    EXPECT_FALSE(world.set(2, motion_at(0, 0), {}));
}

// A wing that turns about +y through (0, 2, 1) of a body that itself stands turned and moved.
TEST(WorldState, AJointTurnsItsPartAboutItsAxis) {
    const Motion initial[2] = {motion_at(0, 0),
                               {{0}, {{5, 0, 0}, from_rotation_vector({0, 0, kPi / 2})}, {}, {}}};
    const Joint joint{0, {0, 2, 1}, {0, 1, 0}, 0.3, 0.1};
    WorldState world(initial, {}, std::span(&joint, 1));
    EXPECT_EQ(world.placed_objects(), 2u);
    WorldSnapshot snapshot;
    snapshot.objects.resize(2);
    ShownCommand shown;
    const auto place_of = [&](std::int64_t ns, Vec3d p) {
        world.sample({ns}, snapshot, shown);
        const Pose& part = snapshot.objects[1];
        return part.position_world_m + to_matrix(part.world_from_body) * p;
    };
    // The pivot stays; a point 1 m over it goes 1 m sideways when turned by a right angle.
    const Vec3d pivot = place_of(0, {0, 2, 1});
    EXPECT_NEAR(length(pivot - Vec3d{5 - 2, 0, 1}), 0, 1e-12);
    EXPECT_NEAR(length(place_of(9'000'000'000, {0, 2, 1}) - pivot), 0, 1e-9);
    // 0.3 + 0.1 t: after 2 s the point is turned by 0.5 about the body's y, the world's -x.
    const Vec3d over = place_of(2'000'000'000, {0, 2, 2});
    EXPECT_NEAR(length(over - (pivot + Vec3d{0, std::sin(0.5), std::cos(0.5)})), 0, 1e-9);
    EXPECT_TRUE(world.set_joint(1, 1, {{3'000'000'000}, kPi / 2, 0}, {8, 1}));
    EXPECT_NEAR(length(place_of(4'000'000'000, {0, 2, 2}) - (pivot + Vec3d{0, 1, 0})), 0, 1e-9);
    EXPECT_EQ(shown.sequence, 8u);
    EXPECT_FALSE(world.set_joint(1, 2, {}, {}));
    EXPECT_FALSE(world.set_joint(2, 1, {}, {}));
    EXPECT_FALSE(world.set(2, motion_at(0, 0), {}));  // a part is no object
}

TEST(WorldState, KeepsTheNewestEightMotions) {
    const Motion initial = motion_at(0, 0);
    WorldState world(std::span(&initial, 1), {});
    for (int i = 1; i <= 20; ++i) world.set(0, motion_at(i * 1'000'000'000LL, i, 1), {1, 1});
    world.set(0, motion_at(1'000'000'000, -100, 1), {2, 2});  // older than all that are kept: ignored
    EXPECT_NEAR(camera_x_m(world, 13'500'000'000), 13.5, 1e-9);
    EXPECT_NEAR(camera_x_m(world, 25'000'000'000), 25, 1e-9);
}

// What rides on a turning body: by hand, for a body that turns at w about z through the origin.
TEST(WorldState, AMountedCameraRidesOnItsBody) {
    const double w = 0.5;
    Motion body = motion_at(0, 0);
    body.velocity_world_m_s = {3, 0, 0};
    body.rate_body_rad_s = {0, 0, w};
    const Quat quarter{std::sqrt(0.5), std::sqrt(0.5), 0, 0};  // about x: camera z is the body's -y
    WorldState world(std::span(&body, 1), {}, {}, {0, {2, 0, 0}, quarter});
    WorldSnapshot snapshot;
    ShownCommand shown;
    world.sample({body.time.ns + 1'000'000'000}, snapshot, shown);
    EXPECT_NEAR(snapshot.camera.position_world_m.x, 3 + 2 * std::cos(w), 1e-9);
    EXPECT_NEAR(snapshot.camera.position_world_m.y, 2 * std::sin(w), 1e-9);
    EXPECT_NEAR(snapshot.camera_velocity_m_s.x, 3 - 2 * w * std::sin(w), 1e-5);
    EXPECT_NEAR(snapshot.camera_velocity_m_s.y, 2 * w * std::cos(w), 1e-5);
    const Vec3d boresight = to_matrix(snapshot.camera.world_from_body) * Vec3d{0, 0, 1};
    EXPECT_NEAR(boresight.x, std::sin(w), 1e-9);
    EXPECT_NEAR(boresight.y, -std::cos(w), 1e-9);
    // w about the body's z is about the camera's y.
    EXPECT_NEAR(snapshot.camera_rate_rad_s.y, w, 1e-5);
    EXPECT_NEAR(snapshot.camera_rate_rad_s.z, 0, 1e-5);
}

}  // namespace
}  // namespace hilcam
