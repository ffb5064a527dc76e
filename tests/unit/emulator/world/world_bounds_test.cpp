// What cannot be - a place that is no number, a speed beyond light - does not get into a frame, whatever it comes from: its thing stays as
// it was, and that is told.

#include <gmock/gmock.h>

#include <limits>

#include "io/contract/frame_flags.h"
#include "render/sky/motion_bounds.h"
#include "render/sky/own_bodies.h"
#include "tests/support/plate.h"
#include "tests/support/world_at.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t kSecond_ns = 1'000'000'000;

// Is told by a function of the seconds since the first instant.
template <class F>
class ToldTrajectory final : public Trajectory {
  public:
    explicit ToldTrajectory(F told) : told_(told) {}
    StateVector at(const MotionContext& context) const override {
        return told_(static_cast<double>(context.frame.time().ns) * 1e-9);
    }
    std::string name() const override { return "told"; }

  private:
    F told_;
};

template <class F>
class ToldAttitude final : public AttitudeLaw {
  public:
    explicit ToldAttitude(F told) : told_(told) {}
    AttitudeState at(const MotionContext& context, const OwnMotion&) const override {
        return told_(static_cast<double>(context.frame.time().ns) * 1e-9);
    }
    std::string name() const override { return "told"; }

  private:
    F told_;
};

StateVector at_rest(double) { return {{1, 2, 3}, {}}; }
AttitudeState unturned(double) { return {{}, {}}; }

template <class Place, class Attitude>
MotionSources camera_source(Place place, Attitude attitude) {
    std::vector<std::unique_ptr<MotionSource>> sources;
    sources.push_back(std::make_unique<MotionSource>(std::make_unique<ToldTrajectory<Place>>(place),
                                                     std::make_unique<ToldAttitude<Attitude>>(attitude)));
    const std::string name = "camera";
    return {std::move(sources), std::span(&name, 1)};
}

struct CameraWorld {
    WorldState state;
    WorldSnapshot snapshot;
    ShownCommand shown;

    template <class Place, class Attitude>
    CameraWorld(Place place, Attitude attitude)
        : state(std::vector<Motion>(1), {}, {}, {}, camera_source(place, attitude)) {}
    const WorldSnapshot& at(double seconds) {
        state.sample({std::llround(seconds * 1e9)}, snapshot, shown);
        return snapshot;
    }
};

TEST(MotionBounds, AreThoseOfLengthsAndOfNumbers) {
    EXPECT_TRUE(is_within({kFarthestPlace_m, 0, 0}, kFarthestPlace_m));
    EXPECT_FALSE(is_within({kFarthestPlace_m, kFarthestPlace_m, 0}, kFarthestPlace_m));
    for (const double bad : {kNoNumber, std::numeric_limits<double>::infinity(), 1e200})
        EXPECT_FALSE(is_within({0, bad, 0}, kFarthestPlace_m)) << bad;
    EXPECT_FALSE(is_turn({0, 0, 0, 0}));
    EXPECT_FALSE(is_turn({kNoNumber, 0, 0, 0}));
    Motion kept{{}, {{1, 2, 3}, {}}, {4, 5, 6}, {}};
    // Each part counts by itself.
    EXPECT_FALSE(take_possible({{}, {{7, 8, 9}, {}}, {1e9, 0, 0}, {1, 0, 0}}, kept));
    EXPECT_EQ(kept.pose.position_world_m.x, 7);
    EXPECT_EQ(length(kept.velocity_world_m_s), 0);
    EXPECT_EQ(kept.rate_body_rad_s.x, 1);
    EXPECT_THAT(impossible_part({{}, {{1e21, 0, 0}, {}}, {}, {}}),
                HasSubstr("a place 1e+21 m from the world's origin; accepted: at most 1.5e+15 m from it"));
    EXPECT_THAT(impossible_part({{}, {{kNoNumber, 0, 0}, {}}, {}, {}}),
                HasSubstr("a place that is no number"));
    EXPECT_THAT(impossible_part({{}, {}, {4e8, 0, 0}, {}}), HasSubstr("a velocity 400000000 m/s; accepted"));
    EXPECT_EQ(impossible_part(kept), "");
}

TEST(WorldBounds, ASourceThatLeavesThemStandsWhereItWas) {
    CameraWorld world(
        [](double t) {
            return t < 10   ? StateVector{{1e3 * t, 0, 0}, {1e3, 0, 0}}
                   : t < 20 ? StateVector{{1e21, 0, 0}, {}}
                   : t < 30 ? StateVector{{kNoNumber, 0, 0}, {}}
                   : t < 40 ? StateVector{{7, 0, 0}, {1e12, 0, 0}}
                            : StateVector{{9, 0, 0}, {}};
        },
        unturned);
    EXPECT_EQ(world.at(5).camera.position_world_m.x, 5e3);
    EXPECT_EQ(world.state.impossible(), 0u);
    for (const double t : {15, 25}) {
        EXPECT_EQ(world.at(t).camera.position_world_m.x, 5e3) << t;
        EXPECT_EQ(length(world.snapshot.camera_velocity_m_s), 0) << t;
    }
    EXPECT_EQ(world.state.impossible(), 2u);
    EXPECT_EQ(world.state.first_impossible(), "the camera's body at " + format_utc({15 * kSecond_ns}));
    // A velocity that cannot be is left out by itself.
    EXPECT_EQ(world.at(35).camera.position_world_m.x, 7);
    EXPECT_EQ(length(world.snapshot.camera_velocity_m_s), 0);
    EXPECT_EQ(world.at(45).camera.position_world_m.x, 9);
    EXPECT_EQ(world.state.impossible(), 3u);
    EXPECT_EQ(world.state.held(), 0u);
}

// What was never asked for was at the start.
TEST(WorldBounds, ASourceThatHasLeftThemBeforeTheFirstFrameStandsAsAtTheStart) {
    CameraWorld world([](double t) { return StateVector{{t > 1 ? kNoNumber : 42, 0, 0}, {}}; }, unturned);
    EXPECT_EQ(world.at(5).camera.position_world_m.x, 42);
}

TEST(WorldBounds, AnAttitudeThatIsNoRotationIsNotTaken) {
    const Quat turned = from_rotation_vector({0.5, 0, 0});
    CameraWorld world(at_rest, [&](double t) {
        return t < 10   ? AttitudeState{turned, {0.1, 0, 0}}
               : t < 20 ? AttitudeState{{kNoNumber, 0, 0, 0}, {}}
               : t < 30 ? AttitudeState{{0, 0, 0, 0}, {}}
                        : AttitudeState{{}, {0, kNoNumber, 0}};
    });
    EXPECT_EQ(world.at(5).camera_rate_rad_s.x, 0.1);
    for (const double t : {15, 25}) {
        EXPECT_EQ(world.at(t).camera.world_from_body.x, turned.x) << t;
        EXPECT_EQ(length(world.snapshot.camera_rate_rad_s), 0) << t;
    }
    EXPECT_EQ(world.at(35).camera.world_from_body.x, 0);
    EXPECT_EQ(length(world.snapshot.camera_rate_rad_s), 0);
    EXPECT_EQ(world.state.impossible(), 3u);
}

// A pose that is possible may lead to one that is not.
TEST(WorldBounds, ACommandedThingThatFliesOutStandsWhereItWasLast) {
    const std::vector<Motion> initial(2);
    WorldState world(initial, {});
    WorldSnapshot snapshot;
    snapshot.objects.resize(1);
    ShownCommand shown;
    world.set(1, motion_at(0, 1.4e15, 2e8), {1, 1});
    world.sample({100'000 * kSecond_ns}, snapshot, shown);
    const double last_m = snapshot.objects[0].position_world_m.x;
    EXPECT_NEAR(last_m, 1.42e15, 1);
    world.sample({1'000'000 * kSecond_ns}, snapshot, shown);
    EXPECT_EQ(snapshot.objects[0].position_world_m.x, last_m);
    EXPECT_EQ(world.impossible(), 1u);
    EXPECT_THAT(world.first_impossible(), HasSubstr("object 1 at "));
    world.set(0, motion_at(0, kNoNumber), {2, 2});
    world.sample({kSecond_ns}, snapshot, shown);
    EXPECT_EQ(snapshot.camera.position_world_m.x, 0);
}

TEST(WorldBounds, ABodyThatIsNowhereStandsWhereItWas) {
    auto own = std::make_shared<OwnBodies>();
    OwnBody& body = own->list.emplace_back();
    body.name = "moonlet", body.figure = {1e5, 1e5}, body.center = BodyId::kEarth, body.synchronous = false;
    body.orbit = [](TimeTai time) { return StateVector{{time.ns > kSecond_ns ? kNoNumber : 1e8, 0, 0}, {}}; };
    OriginConfig origin;
    origin.own = own;
    const std::vector<Motion> initial(1);
    WorldState world(initial, origin);
    WorldSnapshot snapshot;
    ShownCommand shown;
    world.sample({0}, snapshot, shown);
    const Vec3d there_m = snapshot.bodies.body[kBodyCount].world_m, sun_m = snapshot.bodies.sun_world_m;
    EXPECT_EQ(there_m.x, 1e8);
    world.sample({100 * kSecond_ns}, snapshot, shown);
    EXPECT_EQ(snapshot.bodies.body[kBodyCount].world_m.x, there_m.x);
    EXPECT_GT(length(snapshot.bodies.sun_world_m - sun_m), 1e3);  // the others move on
    EXPECT_THAT(world.first_impossible(), HasSubstr("a body of the sky at "));
}

class FrameBounds : public PlateTest {};

TEST_F(FrameBounds, AFrameSaysThatSomethingInItCouldNotBe) {
    LoopRig rig(scenario(), {}, {"mode=lockstep"});
    rig.loop.start();
    const auto after = [&](std::int64_t s) { return rig.start + s * kSecond_ns; };
    EXPECT_EQ(rig.send(camera_pose_at(after(0), 1.4e15, 2e8)), CommandStatus::kAccepted);
    for (const std::int64_t s : {1, 1'000'000})
        EXPECT_EQ(rig.send(ExposeCommand{after(s), 1}), CommandStatus::kAccepted);
    EXPECT_EQ(rig.send(camera_pose_at(after(1'000'001), 0)), CommandStatus::kAccepted);
    EXPECT_EQ(rig.send(ExposeCommand{after(1'000'001), 1}), CommandStatus::kAccepted);
    ASSERT_TRUE(rig.collector.wait_for(3));
    rig.loop.stop();
    const auto& frames = rig.collector.frames;
    EXPECT_EQ(frames[0].record.faults, 0u);
    EXPECT_EQ(frames[1].record.faults, kImpossibleMotionBit);
    EXPECT_NEAR(frames[1].record.camera.value().position_world_m.x, 1.4e15, 1e9);
    EXPECT_EQ(frames[2].record.faults, 0u);
    EXPECT_EQ(rig.loop.counters().impossible.load(), 1u);
}

TEST_F(FrameBounds, AMeshLargerThanTheSunIsRefused) {
    const ScenarioConfig s = load_scenario(scenario(), {});
    write("plate.obj", "v -1e10 0 0\nv 1e10 0 0\nv 0 1e10 0\nf 1 2 3\n");
    EXPECT_THAT(
        error_of([&] { load_renderer(s, SpectralGrid(s.spectrum_edges_um), geometry_of(s.camera, 0)); }),
        HasSubstr("plate.obj: found a vertex 1e+10 m from the mesh's origin, by the object's scale; "
                  "accepted: at most 1e9 m"));
}

// Wherever a command comes from: an event, Vizard, the wire.
TEST_F(FrameBounds, ACommandOfWhatCannotBeIsRefused) {
    LoopRig rig(scenario(), {}, {"mode=lockstep"});
    for (const double x_m : {kNoNumber, 1e16, -std::numeric_limits<double>::infinity()})
        EXPECT_EQ(rig.send(camera_pose_at(rig.start, x_m)), CommandStatus::kBadArgument) << x_m;
    EXPECT_EQ(rig.send(camera_pose_at(rig.start, 0, 4e8)), CommandStatus::kBadArgument);
    EXPECT_EQ(rig.send(camera_pose_at(rig.start, 1e15)), CommandStatus::kAccepted);
}

}  // namespace
}  // namespace hilcam
