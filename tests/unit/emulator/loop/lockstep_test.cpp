// Cameras in lockstep: a frame for each command, at any pace.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "tests/support/plate.h"

namespace hilcam {
namespace {

std::vector<Collector::Frame> fly_in_lockstep(const std::filesystem::path& file, bool slowly) {
    LoopRig rig(file, {}, {"mode=lockstep"});
    rig.loop.start();
    for (int i = 0; i < 6; ++i) {
        const TimeTai time = rig.start + (i + 1) * 100'000'000;
        EXPECT_EQ(rig.send(camera_pose_at(time, 0.01 * i)), CommandStatus::kAccepted);
        EXPECT_EQ(rig.send(expose(time)), CommandStatus::kAccepted);
        if (slowly && i % 2 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(30));
    }
    EXPECT_TRUE(rig.collector.wait_for(6));
    rig.loop.stop();
    return std::move(rig.collector.frames);
}

TEST_F(FrameLoopTest, LockstepGivesOneFrameACommandAndTheSameAtAnyPace) {
    const auto file = scenario();
    const auto quick = fly_in_lockstep(file, false), slow = fly_in_lockstep(file, true);
    ASSERT_EQ(quick.size(), 6u);
    ASSERT_EQ(slow.size(), 6u);
    const TimeTai start = parse_utc("2026-12-21T00:00:00Z");
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(quick[i].dn, slow[i].dn) << i;
        EXPECT_EQ(quick[i].record.id, i + 1);
        EXPECT_EQ(quick[i].record.exposure_mid, start + static_cast<std::int64_t>(i + 1) * 100'000'000);
        EXPECT_EQ(quick[i].record.pose_time, quick[i].record.exposure_mid);
        EXPECT_EQ(quick[i].record.pose_sequence, 2 * i + 1);
        EXPECT_EQ(quick[i].record.trigger_sequence, 2 * i + 2);
        // 10 mm a step at 4 m and 640 px: the plate goes 1.6 px to the left.
        EXPECT_NEAR(plate_x_px(quick[i]), 32 - 1.6 * static_cast<double>(i), 0.2) << i;
    }
}

TEST_F(FrameLoopTest, LockstepGoesOnByTheFramePeriodAndNeverBack) {
    LoopRig rig(scenario(", frame_rate_hz: 10"), {}, {"mode=lockstep"});
    rig.loop.start();
    EXPECT_EQ(rig.send(expose()), CommandStatus::kAccepted);
    EXPECT_EQ(rig.send(expose({}, 3)), CommandStatus::kAccepted);
    EXPECT_EQ(rig.send(expose(rig.start + 5'000'000'000)), CommandStatus::kAccepted);
    EXPECT_EQ(rig.send(expose(rig.start + 4'000'000'000)), CommandStatus::kTimeOutOfRange);
    EXPECT_EQ(rig.dispatch.now(), rig.start + 5'000'000'000);
    ASSERT_TRUE(rig.collector.wait_for(5));
    const std::int64_t expected_ns[] = {10'000'000, 110'000'000, 210'000'000, 310'000'000, 5'000'000'000};
    for (std::size_t i = 0; i < 5; ++i)
        EXPECT_EQ(rig.collector.frames[i].record.exposure_mid.ns - rig.start.ns, expected_ns[i]) << i;
    // No other source makes frames, and the mode is not left.
    EXPECT_EQ(rig.settings.trigger({}), TriggerResult::kNotArmed);
    EXPECT_EQ(rig.send(TriggerModeCommand{false, 0}), CommandStatus::kNotNow);
    rig.loop.stop();
    EXPECT_EQ(rig.send(expose()), CommandStatus::kNotNow);  // nobody would answer
}

// Three exposures in turn: a frame's middle is the time of its command, whatever set it uses.
TEST_F(FrameLoopTest, LockstepGivesEachFrameItsSetOfTheSequencerAndTheSameAtAnyPace) {
    const auto file = scenario();
    std::vector<std::vector<Collector::Frame>> runs;
    for (const bool slowly : {false, true}) {
        LoopRig rig(file, {}, {"mode=lockstep"});
        SequencerProgram program;
        for (std::uint8_t i = 0; i < 3; ++i) {
            keep_in(program.sets[i], rig.settings.settings());
            program.sets[i].exposure_s = 1e-3 * (1 << i);
            program.sets[i].gain_db = i;
            program.sets[i].paths[0] = {static_cast<std::uint8_t>((i + 1) % 3), LineEvent::kExposureEnd};
        }
        rig.settings.sequencer()->start(program);
        rig.loop.start();
        for (int i = 0; i < 5; ++i) {
            EXPECT_EQ(rig.send(expose(rig.start + (i + 1) * 100'000'000)), CommandStatus::kAccepted);
            if (slowly) std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        ASSERT_TRUE(rig.collector.wait_for(5));
        rig.loop.stop();
        for (int i = 0; i < 5; ++i) {
            const FrameRecord& r = rig.collector.frames[static_cast<std::size_t>(i)].record;
            EXPECT_EQ(r.sequencer_set, i % 3);
            EXPECT_EQ(r.exposure_s, 1e-3 * (1 << i % 3));
            EXPECT_EQ(r.gain_db, i % 3);
            EXPECT_EQ(r.exposure_mid, rig.start + (i + 1) * 100'000'000);
        }
        runs.push_back(std::move(rig.collector.frames));
    }
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(runs[0][i].dn, runs[1][i].dn) << i;
}

// Frames that name no time go on from the one before; a time that these have passed is over.
TEST_F(FrameLoopTest, LockstepNeverGoesBackBehindFramesWithoutATime) {
    LoopRig rig(scenario(", frame_rate_hz: 10", "mode: lockstep\n"), {});
    rig.loop.start();
    const auto at_ms = [&](std::int64_t ms) { return rig.start + ms * 1'000'000; };
    EXPECT_EQ(rig.send(ExposeCommand{at_ms(1000), 1}), CommandStatus::kAccepted);
    EXPECT_EQ(rig.send(ExposeCommand{{}, 5}), CommandStatus::kAccepted);  // up to 1500 ms
    EXPECT_EQ(rig.send(ExposeCommand{at_ms(1200), 1}), CommandStatus::kTimeOutOfRange);
    EXPECT_EQ(rig.send(ExposeCommand{at_ms(1500), 1}), CommandStatus::kTimeOutOfRange);
    EXPECT_EQ(rig.send(ExposeCommand{at_ms(1501), 1}), CommandStatus::kAccepted);
    ASSERT_TRUE(rig.collector.wait_for(7));
    rig.loop.stop();
    for (std::size_t i = 1; i < rig.collector.frames.size(); ++i)
        EXPECT_LT(rig.collector.frames[i - 1].record.exposure_mid,
                  rig.collector.frames[i].record.exposure_mid);
}

// For simulators that tell the whole world for each frame, and start anew.
TEST_F(FrameLoopTest, LockstepGoesToAnyTimeForWhoAsksAndForgetsWhatWasThere) {
    LoopRig rig(scenario(), {}, {"mode=lockstep"});
    rig.loop.start();
    const std::int64_t times_s[] = {100, 100, 40, -1000};
    for (int i = 0; i < 4; ++i) {
        const TimeTai time = rig.start + times_s[i] * 1'000'000'000;
        PoseCommand pose = camera_pose_at(time, 0.01 * i);
        pose.alone = true;
        EXPECT_EQ(rig.send(pose), CommandStatus::kAccepted);
        EXPECT_EQ(rig.send(ExposeCommand{time, 1, true}), CommandStatus::kAccepted) << i;
    }
    EXPECT_EQ(rig.send(expose(rig.start + 40'000'000'000)), CommandStatus::kAccepted);  // after -1000 s
    EXPECT_EQ(rig.send(expose(rig.start)), CommandStatus::kTimeOutOfRange);
    ASSERT_TRUE(rig.collector.wait_for(5));
    rig.loop.stop();
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(rig.collector.frames[i].record.exposure_mid - rig.start, times_s[i] * 1'000'000'000) << i;
        // The later pose has all of its values: with those that were known before it would be a mixture.
        EXPECT_NEAR(plate_x_px(rig.collector.frames[i]), 32 - 1.6 * static_cast<double>(i), 0.2) << i;
    }
}

// An output that has no room yet gets the last frames, too, when the loop is stopped or has taken all that it
// was to take.
TEST_F(FrameLoopTest, LockstepWaitsForOutputsAtTheEndAsWell) {
    class Slow : public Collector {
      public:
        bool has_room() const noexcept override { return monotonic_ns() >= room_ns_; }
        void publish(const DnImage& frame, const FrameRecord& record) noexcept override {
            if (!has_room()) lost_ += 1;
            room_ns_ = monotonic_ns() + 100'000'000;
            Collector::publish(frame, record);
        }
        int lost() const { return lost_; }

      private:
        std::atomic<std::int64_t> room_ns_{0};
        std::atomic<int> lost_{0};
    };
    for (const std::uint64_t limit : {0u, 4u}) {
        LoopRig rig(scenario(), {}, {"mode=lockstep"});
        Slow slow;
        LoopParts parts = rig.parts({limit, 0, false});
        parts.sinks = {&slow};
        FrameLoop loop(parts);
        loop.start();
        EXPECT_EQ(rig.send(expose({}, 4)), CommandStatus::kAccepted);
        loop.stop();
        EXPECT_EQ(slow.count(), 4u);
        EXPECT_EQ(slow.lost(), 0) << limit;
    }
}

}  // namespace
}  // namespace hilcam
