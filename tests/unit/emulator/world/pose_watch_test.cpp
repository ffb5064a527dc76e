// What becomes of poses' time tags, and what commands' answers say of it.

#include "emulator/world/pose_watch.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "emulator/run/command_dispatch.h"
#include "emulator/scenario/app_config.h"
#include "render/vocabulary/check.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using Verdict = PoseWatch::Verdict;

TEST(PoseWatch, SilenceBeginsAfterTheNewestArrivalAndEndsWithTheNext) {
    PoseWatch watch({.stale_after_s = 0.5});
    EXPECT_FALSE(watch.at({1'000 * kSecond_ns}).stale);  // nothing was ever sent
    watch.took({0, 0}, {3 * kSecond_ns}, {10 * kSecond_ns}, Verdict::kForwards);
    EXPECT_FALSE(watch.at({10 * kSecond_ns + 500'000'000}).stale);
    const PoseWatch::Silence silence = watch.at({10 * kSecond_ns + 500'000'001});
    EXPECT_TRUE(silence.stale);
    EXPECT_EQ(silence.since.ns, 10 * kSecond_ns + 500'000'000);
    // Threads of two receivers: an earlier arrival told later changes nothing.
    watch.took({1, 0}, {3 * kSecond_ns}, {9 * kSecond_ns}, Verdict::kForwards);
    EXPECT_EQ(watch.at({20 * kSecond_ns}).since, silence.since);
    watch.took({1, 2}, {3 * kSecond_ns}, {20 * kSecond_ns}, Verdict::kForwards);
    EXPECT_FALSE(watch.at({20 * kSecond_ns}).stale);
    EXPECT_FALSE(PoseWatch().at({20 * kSecond_ns}).stale);
}

TEST(PoseWatch, TheCameraAloneIsWatchedWhereThatIsAsked) {
    PoseWatch watch({.stale_after_s = 1, .when_stale = WhenStale::kStop, .watch = WatchedPoses::kCamera});
    watch.took({1, 0}, {0}, {10 * kSecond_ns}, Verdict::kForwards);
    EXPECT_FALSE(watch.stops({100 * kSecond_ns}));
    watch.took({0, 0}, {0}, {10 * kSecond_ns}, Verdict::kForwards);
    watch.took({1, 0}, {0}, {99 * kSecond_ns}, Verdict::kForwards);
    EXPECT_TRUE(watch.stops({100 * kSecond_ns}));
}

TEST(PoseWatch, InLockstepTagsCountAndNoTagOverflows) {
    PoseWatch watch({.stale_after_s = 0.5}, true);
    watch.took({0, 0}, {3 * kSecond_ns}, {10 * kSecond_ns}, Verdict::kForwards);
    EXPECT_FALSE(watch.at({3'400'000'000}).stale);
    EXPECT_TRUE(watch.at({3'600'000'000}).stale);
    watch.took({0, 0}, {1 * kSecond_ns}, {10 * kSecond_ns}, Verdict::kAnew);  // the sender begins anew
    EXPECT_TRUE(watch.at({1'600'000'000}).stale);
    EXPECT_EQ(watch.went_back(), 0u);
    constexpr TimeTai kFirst{std::numeric_limits<std::int64_t>::min()},
        kLast{std::numeric_limits<std::int64_t>::max()};
    watch.took({0, 0}, kLast, {}, Verdict::kForwards);
    EXPECT_FALSE(watch.at(kLast).stale);
    EXPECT_EQ(watch.judge({0, 0}, kFirst), Verdict::kBackwards);
}

// A bench with a camera's body and one object with a joint, and its commands.
struct Bench {
    CameraModel camera;
    LiveSettings settings{camera};
    std::array<Motion, 2> initial{};
    Joint joint;
    WorldState world{initial, {}, std::span(&joint, 1)};
    FaultBoard faults;
    const TimeTai start{1'000'000 * kSecond_ns};
    SimulatedClock clock{start, 0};
    PoseWatch poses;
    CommandDispatch dispatch{{{&world, &settings, &faults}}, clock, &poses};
    CommandNotes notes;

    explicit Bench(const PoseRules& rules) : poses(rules) {}
    // Arrives 100 s after the start.
    CommandStatus pose(std::int64_t tag_s, double x_m, std::uint16_t object = 0) {
        PoseCommand command;
        command.object = object;
        command.motion.time = tag_s == 0 ? TimeTai{} : start + tag_s * kSecond_ns;
        command.motion.pose.position_world_m = {x_m, 0, 0};
        notes = {};
        return dispatch.handle(command, {++sequence, 100 * kSecond_ns, 0, &notes});
    }
    CommandStatus turn(std::int64_t tag_s, std::uint16_t number = 1) {
        notes = {};
        return dispatch.handle(JointCommand{1, number, start + tag_s * kSecond_ns, 0.5, 0},
                               {++sequence, 100 * kSecond_ns, 0, &notes});
    }
    double x_m(std::int64_t at_s) {
        WorldSnapshot snapshot;
        snapshot.objects.resize(world.placed_objects());
        ShownCommand shown;
        world.sample(start + at_s * kSecond_ns, snapshot, shown);
        return snapshot.camera.position_world_m.x;
    }
    std::uint32_t sequence = 0;
};

TEST(TimeTags, BeyondTheHorizonTheyAreRefused) {
    Bench bench({.horizon_s = 10});
    EXPECT_EQ(bench.pose(89, 1), CommandStatus::kTimeOutOfRange);
    EXPECT_EQ(bench.pose(111, 1), CommandStatus::kTimeOutOfRange);
    EXPECT_EQ(bench.pose(90, 1), CommandStatus::kAccepted);
    EXPECT_EQ(bench.pose(110, 1), CommandStatus::kAccepted);
    EXPECT_EQ(bench.turn(80), CommandStatus::kTimeOutOfRange);
    EXPECT_EQ(bench.poses.went_back(), 0u);
}

TEST(TimeTags, ALateOneTakesItsPlace) {
    Bench bench({.late_s = 2});
    EXPECT_EQ(bench.pose(100, 10), CommandStatus::kAccepted);
    EXPECT_EQ(bench.pose(98, 8), CommandStatus::kAccepted);
    EXPECT_FALSE(bench.notes.went_back);
    EXPECT_NEAR(bench.x_m(99), 9, 1e-9);  // between the two
    EXPECT_EQ(bench.poses.went_back(), 0u);
}

TEST(TimeTags, ThatWentBackBeginTheThingAnewAndAreFlagged) {
    Bench bench({});
    EXPECT_EQ(bench.pose(100, 10), CommandStatus::kAccepted);
    EXPECT_EQ(bench.pose(101, 11), CommandStatus::kAccepted);
    EXPECT_EQ(bench.pose(50, 5), CommandStatus::kAccepted);
    EXPECT_TRUE(bench.notes.went_back);
    EXPECT_TRUE(bench.notes.notify_sender);
    EXPECT_EQ(bench.x_m(100), 5);  // nothing of before
    EXPECT_EQ(bench.poses.flagged(), 1u);
    EXPECT_EQ(bench.pose(51, 6), CommandStatus::kAccepted);  // and on from there
    EXPECT_FALSE(bench.notes.went_back);
    // By thing: the object's time has not gone back, nor that of its joint.
    EXPECT_EQ(bench.pose(20, 1, 1), CommandStatus::kAccepted);
    EXPECT_EQ(bench.turn(10), CommandStatus::kAccepted);
    EXPECT_EQ(bench.poses.went_back(), 1u);
    EXPECT_EQ(bench.turn(5), CommandStatus::kAccepted);
    EXPECT_TRUE(bench.notes.went_back);
    // "On arrival" is now, whatever came before.
    EXPECT_EQ(bench.pose(200, 1), CommandStatus::kAccepted);
    EXPECT_EQ(bench.pose(0, 2), CommandStatus::kAccepted);
    EXPECT_FALSE(bench.notes.went_back);
}

TEST(TimeTags, ThatWentBackAreRefusedWhereThatIsAsked) {
    Bench bench({.backwards = WhenBackwards::kRefuse});
    EXPECT_EQ(bench.pose(100, 10), CommandStatus::kAccepted);
    EXPECT_EQ(bench.pose(50, 5), CommandStatus::kTimeBackwards);
    EXPECT_TRUE(bench.notes.went_back);
    EXPECT_FALSE(bench.notes.notify_sender);
    EXPECT_EQ(bench.x_m(100), 10);
    EXPECT_EQ(bench.pose(101, 11), CommandStatus::kAccepted);  // the stream goes on
    EXPECT_EQ(bench.poses.went_back(), 1u);
    EXPECT_EQ(bench.poses.flagged(), 0u);
    Bench accepting({.backwards = WhenBackwards::kAccept});
    EXPECT_EQ(accepting.pose(100, 10), CommandStatus::kAccepted);
    EXPECT_EQ(accepting.pose(50, 5), CommandStatus::kAccepted);
    EXPECT_EQ(accepting.x_m(100), 5);
    EXPECT_TRUE(accepting.notes.went_back);
    EXPECT_FALSE(accepting.notes.notify_sender);
    EXPECT_EQ(accepting.poses.flagged(), 0u);
    EXPECT_EQ(accepting.poses.went_back(), 1u);
}

// What is not there is not remembered, whatever is sent.
TEST(TimeTags, UnknownThingsHaveNone) {
    Bench bench({.backwards = WhenBackwards::kRefuse});
    for (const std::int64_t tag_s : {100, 50}) {
        EXPECT_EQ(bench.pose(tag_s, 1, 7), CommandStatus::kUnknownObject);
        EXPECT_EQ(bench.turn(tag_s, 9), CommandStatus::kUnknownObject);
    }
    EXPECT_EQ(bench.poses.went_back(), 0u);
}

class TimeConfig : public FilesTest {};

TEST_F(TimeConfig, WhatLockstepCannotHaveIsRefusedByName) {
    const auto error_of = [&](const std::vector<std::string>& overrides) -> std::string {
        try {
            load_scenario(HILCAM_SOURCE_DIR "/tests/protocol/minimal_scenario.yaml", overrides);
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    };
    const auto has = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos ? testing::AssertionSuccess()
                                                    : testing::AssertionFailure() << text;
    };
    EXPECT_TRUE(has(error_of({"mode=lockstep", "clock.scale=2"}),
                    "clock.scale: found 2; accepted with 'mode: lockstep': 1"));
    EXPECT_TRUE(has(error_of({"mode=lockstep", "clock.paused=true"}), "clock.paused: found true"));
    EXPECT_TRUE(has(error_of({"mode=lockstep", "commands.poses.when_stale=stop"}),
                    "commands.poses.when_stale: found 'stop'"));
    EXPECT_TRUE(has(error_of({"clock.scale=0"}), "clock.scale: found '0'"));
    EXPECT_TRUE(has(error_of({"clock.camera_in_pause=sleeps"}), "streams"));
    EXPECT_TRUE(has(error_of({"commands.poses.horizon_s=0"}), "commands.poses.horizon_s: found '0'"));
    EXPECT_TRUE(has(error_of({"commands.poses.backwards=ignore"}), "refuse"));
    EXPECT_EQ(error_of({"clock.scale=0.1", "clock.paused=true", "clock.camera_in_pause=waits",
                        "commands.poses.stale_after_s=2", "commands.poses.when_stale=stop",
                        "commands.poses.watch=camera", "commands.poses.backwards=refuse"}),
              "no error");
}

}  // namespace
}  // namespace hilcam
