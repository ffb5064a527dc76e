#include <gtest/gtest.h>

#include <limits>

#include "emulator/run/command_dispatch.h"
#include "tests/support/world_at.h"

namespace hilcam {
namespace {

// A bench of one camera.
struct OneCamera {
    CameraModel camera;
    LiveSettings settings{camera};
    Motion initial = motion_at(0, 0);
    WorldState world{std::span(&initial, 1), {}};
    SimulatedClock clock{{1'000'000'000'000'000}, 0};
    FaultBoard faults;
    CommandDispatch dispatch{{{&world, &settings, &faults}}, clock};
};

TEST(CommandDispatch, SettingsAreAllOrNothingAndTimeTagsAreBounded) {
    OneCamera one;
    CommandDispatch& dispatch = one.dispatch;
    LiveSettings& settings = one.settings;
    SettingsCommand command;
    command.gain_db = 3;
    command.exposure_s = 1e9;
    EXPECT_EQ(dispatch.handle(command, {1, 0}), CommandStatus::kBadArgument);
    EXPECT_EQ(settings.settings().gain_db, one.camera.gain_db);
    PoseCommand pose;
    pose.motion.time.ns = std::numeric_limits<std::int64_t>::min();
    EXPECT_EQ(dispatch.handle(pose, {1, 0}), CommandStatus::kTimeOutOfRange);
    pose.motion.time.ns = 0;
    EXPECT_EQ(dispatch.handle(pose, {1, 0}), CommandStatus::kAccepted);
    pose.object = 9;
    EXPECT_EQ(dispatch.handle(pose, {1, 0}), CommandStatus::kUnknownObject);
    dispatch.handle(StopCommand{}, {1, 0});
    EXPECT_FALSE(settings.settings().running);
}

TEST(CommandDispatch, ACommandIsForTheCameraItNamesAndAPoseForAll) {
    CameraModel camera;
    LiveSettings left(camera), right(camera);
    const Motion initial = motion_at(0, 0);
    WorldState left_world(std::span(&initial, 1), {}), right_world(std::span(&initial, 1), {});
    FaultBoard left_faults, right_faults;
    SimulatedClock clock({1'000'000'000'000'000}, 0);
    CommandDispatch dispatch({{&left_world, &left, &left_faults}, {&right_world, &right, &right_faults}},
                             clock);
    SettingsCommand settings;
    settings.gain_db = 3;
    EXPECT_EQ(dispatch.handle(settings, {1, 0, 2}), CommandStatus::kAccepted);
    EXPECT_EQ(left.settings().gain_db, 0);
    EXPECT_EQ(right.settings().gain_db, 3);
    settings.gain_db = 6;
    EXPECT_EQ(dispatch.handle(settings, {2, 0, 0}), CommandStatus::kAccepted);
    EXPECT_EQ(left.settings().gain_db, 6);
    EXPECT_EQ(right.settings().gain_db, 6);
    EXPECT_EQ(dispatch.handle(settings, {3, 0, 3}), CommandStatus::kUnknownObject);
    ASSERT_TRUE(right.change({.automatic_exposure = true}));
    settings.gain_db = 9;
    settings.exposure_s = 0.002;
    EXPECT_EQ(dispatch.handle(settings, {3, 0, 0}), CommandStatus::kBadArgument);  // none, as one cannot
    EXPECT_EQ(left.settings().gain_db, 6);
    EXPECT_EQ(right.settings().gain_db, 6);
    EXPECT_EQ(dispatch.handle(FaultCommand{{FaultKind::kFrameDrop, 1, 0, 0, 0, 0}, false}, {4, 0, 1}),
              CommandStatus::kAccepted);
    EXPECT_TRUE(left_faults.order_of(FaultKind::kFrameDrop));
    EXPECT_FALSE(right_faults.order_of(FaultKind::kFrameDrop));
    PoseCommand pose;
    pose.motion = motion_at(1'000'000'000'000'000, 7);
    EXPECT_EQ(dispatch.handle(pose, {5, 1, 1}), CommandStatus::kAccepted);
    EXPECT_EQ(camera_x_m(left_world, 1'000'000'000'000'000), 7);
    EXPECT_EQ(camera_x_m(right_world, 1'000'000'000'000'000), 7);
}

TEST(CommandDispatch, ARefusalOfManyCamerasSaysWhichOne) {
    CameraModel camera;
    LiveSettings left(camera, {.triggered = true}), right(camera, {.triggered = true});
    const Motion initial = motion_at(0, 0);
    WorldState left_world(std::span(&initial, 1), {}), right_world(std::span(&initial, 1), {});
    FaultBoard left_faults, right_faults;
    SimulatedClock clock({1'000'000'000'000'000}, 0);
    left.follow(clock, nullptr), right.follow(clock, nullptr);
    CommandDispatch dispatch({{&left_world, &left, &left_faults}, {&right_world, &right, &right_faults}},
                             clock);
    const auto refused_by = [&](const Command& command, std::uint16_t for_camera, CommandStatus expected) {
        CommandNotes notes;
        EXPECT_EQ(dispatch.handle(command, {1, 0, for_camera, &notes}), expected);
        return notes.refused_by;
    };
    const ExposeCommand picture{{1'000'000'000'000'000}, 1};
    EXPECT_EQ(refused_by(picture, 2, CommandStatus::kAccepted), 0);
    EXPECT_EQ(refused_by(picture, 0, CommandStatus::kBusy), 2);
    EXPECT_EQ(refused_by(picture, 1, CommandStatus::kBusy), 0);  // there is no other that it could be
    ASSERT_TRUE(right.change({.automatic_exposure = true}));
    EXPECT_EQ(refused_by(SettingsCommand{0.002, {}, {}}, 0, CommandStatus::kBadArgument), 2);
}

TEST(CommandDispatch, AModeWithoutANumberOfFramesLeavesTheBurstAsItIs) {
    OneCamera one;
    CommandDispatch& dispatch = one.dispatch;
    LiveSettings& settings = one.settings;
    EXPECT_EQ(dispatch.handle(TriggerModeCommand{true, 5}, {1, 0}), CommandStatus::kAccepted);
    EXPECT_TRUE(settings.settings().triggered);
    EXPECT_EQ(settings.settings().burst_frames, 5);
    EXPECT_EQ(dispatch.handle(TriggerModeCommand{false, 0}, {2, 0}), CommandStatus::kAccepted);
    EXPECT_FALSE(settings.settings().triggered);
    EXPECT_EQ(settings.settings().burst_frames, 5);
}

TEST(CommandDispatch, AnOrderOfAFaultReplacesTheOneBeforeAndKindNoughtEndsAll) {
    CameraModel camera;
    LiveSettings left(camera), right(camera);
    const Motion initial = motion_at(0, 0);
    WorldState world(std::span(&initial, 1), {});
    FaultBoard left_faults, right_faults;
    SimulatedClock clock({1'000'000'000'000'000}, 0);
    CommandDispatch dispatch({{&world, &left, &left_faults}, {&world, &right, &right_faults}}, clock);
    const auto order = [&](const FaultCommand& fault, std::uint16_t for_camera = 0) {
        EXPECT_EQ(dispatch.handle(fault, {1, 0, for_camera}), CommandStatus::kAccepted);
    };
    order({{FaultKind::kPacketDrop, 0.5, 0, 0, 0, 0}, false});
    order({{FaultKind::kPacketDelay, 1, 7, 0, 0, 0}, false});
    order({{FaultKind::kPacketDrop, 0.25, 0, 0, 0, 0}, false}, 2);
    EXPECT_EQ(left_faults.order_of(FaultKind::kPacketDrop)->rate, 0.5);
    EXPECT_EQ(right_faults.order_of(FaultKind::kPacketDrop)->rate, 0.25);
    order({{FaultKind::kPacketDrop, 0, 0, 0, 0, 0}, false});  // a rate of 0 ends this kind
    EXPECT_FALSE(left_faults.order_of(FaultKind::kPacketDrop));
    EXPECT_TRUE(left_faults.order_of(FaultKind::kPacketDelay));
    order({{}, true});
    for (const FaultBoard* board : {&left_faults, &right_faults})
        EXPECT_FALSE(board->order_of(FaultKind::kPacketDelay));
}

TEST(CommandDispatch, ARefusedSettingNamesItsLimitsAndATriggerTheRunsEnd) {
    CameraModel camera;
    LiveSettings settings(camera, {.lockstep = true});
    const Motion initial = motion_at(0, 0);
    WorldState world(std::span(&initial, 1), {});
    SimulatedClock clock({1'000'000'000'000'000}, 0);
    FaultBoard faults;
    CommandDispatch dispatch({{&world, &settings, &faults}}, clock);
    const auto why = [&](const Command& command, CommandStatus expected) {
        CommandNotes notes;
        EXPECT_EQ(dispatch.handle(command, {1, 0, 0, &notes}), expected);
        return notes.why;
    };
    EXPECT_EQ(why(SettingsCommand{5000, {}, {}}, CommandStatus::kBadArgument),
              "exposure_s: found 5000; accepted: 1e-06 to 10");
    EXPECT_EQ(why(SettingsCommand{0.002, {}, {}}, CommandStatus::kAccepted), "");
    EXPECT_EQ(why(TriggerModeCommand{false, 0}, CommandStatus::kNotNow),
              "triggered: in lockstep each 'expose' takes a frame, and stays so");
    settings.close();
    const std::string end = why(ExposeCommand{{}, 1}, CommandStatus::kNotNow);
    EXPECT_EQ(end.substr(0, 14), "the run ends: ");
    EXPECT_LE(end.size(), 96u) << "more does not travel";
}

}  // namespace
}  // namespace hilcam
