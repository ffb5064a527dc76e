// Frames while simulated time is slow, fast, stands, steps; and when poses stop or go back.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <thread>

#include "io/contract/frame_flags.h"
#include "render/vocabulary/units.h"
#include "tests/support/plate.h"

namespace hilcam {
namespace {

using Action = ClockCommand::Action;

constexpr std::int64_t kMs_ns = 1'000'000;

PoseCommand pose_at(TimeTai time, double x_m, double velocity_m_s = 0) {
    PoseCommand command;
    command.motion.time = time;
    command.motion.pose.position_world_m = {x_m, 0, 0};
    command.motion.velocity_world_m_s = {velocity_m_s, 0, 0};
    return command;
}
ClockCommand step(std::int64_t ns) { return {Action::kStep, 0, 1, ns}; }
void sleep_ms(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

// Of the light; the plate's 10 mm are 1.6 px, the other way.
double mean_x(const Collector::Frame& f) {
    double sum = 0, light = 0;
    for (std::size_t i = 0; i < f.dn.size(); ++i) {
        const double dn = std::max(0.0, f.dn[i] - 100.0);  // above noise
        light += dn, sum += dn * (static_cast<double>(i % static_cast<std::size_t>(f.width)) + 0.5);
    }
    return sum / light;
}

// --- scale

// A camera that flies past the plate, triggered at simulated instants.
std::vector<Collector::Frame> fly_by(const std::filesystem::path& file, const std::string& scale) {
    LoopRig rig(file, {0, true}, {"mode=triggered", "clock.scale=" + scale});
    EXPECT_EQ(rig.send(pose_at(rig.start, 0, 0.05)), CommandStatus::kAccepted);
    rig.loop.start();
    for (const std::int64_t at_ms : {1000, 1100, 1500})
        EXPECT_EQ(rig.send(ExposeCommand{rig.start + at_ms * kMs_ns, 1}), CommandStatus::kAccepted);
    EXPECT_TRUE(rig.collector.wait_for(3));
    rig.loop.stop();
    return std::move(rig.collector.frames);
}

TEST_F(PlateTest, AtAnyScaleTheSameInstantsGiveTheSameFrames) {
    const auto file = scenario(", frame_rate_hz: 50, frame_rate_range_hz: [1, 50]");
    const auto real = fly_by(file, "1"), fast = fly_by(file, "5"), slow = fly_by(file, "0.5");
    const TimeTai start = parse_utc("2026-12-21T00:00:00Z");
    const std::int64_t expected_ms[] = {1010, 1110, 1510};
    ASSERT_EQ(real.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(real[i].record.exposure_mid - start, expected_ms[i] * kMs_ns);
        // 50 mm/s at 4 m and 640 px: 8 px/s.
        EXPECT_NEAR(mean_x(real[i]), 32 - 8e-3 * static_cast<double>(expected_ms[i]), 0.2);
        for (const auto* other : {&fast, &slow}) {
            EXPECT_EQ((*other)[i].record.exposure_mid, real[i].record.exposure_mid);
            EXPECT_EQ((*other)[i].record.exposure_s, 0.02);
            EXPECT_EQ((*other)[i].dn, real[i].dn) << i;
            EXPECT_EQ((*other)[i].record.faults, 0u);
        }
    }
    const auto machine_ns = [](const auto& frames) {
        return frames[2].record.exposure_mid_monotonic_ns - frames[0].record.exposure_mid_monotonic_ns;
    };
    EXPECT_EQ(machine_ns(real), 500 * kMs_ns);
    EXPECT_NEAR(static_cast<double>(machine_ns(fast)), 100e6, 1);
    EXPECT_NEAR(static_cast<double>(machine_ns(slow)), 1000e6, 1);
}

TEST_F(PlateTest, FreeRunKeepsItsSimulatedRasterThroughChangesOfScale) {
    LoopRig rig(scenario(", frame_rate_hz: 50"), {0, true}, {"clock.scale=0.5"});
    rig.loop.start();
    ASSERT_TRUE(rig.collector.wait_for(3));
    ASSERT_EQ(rig.send(ClockCommand{Action::kScale, 0, 2, 0}), CommandStatus::kAccepted);
    ASSERT_TRUE(rig.collector.wait_for(8));
    ASSERT_EQ(rig.send(ClockCommand{Action::kScale, 0, 0.25, 0}), CommandStatus::kAccepted);
    ASSERT_TRUE(rig.collector.wait_for(11));
    rig.loop.stop();
    const auto& frames = rig.collector.frames;
    for (std::size_t i = 1; i < frames.size(); ++i) {
        const FrameRecord &a = frames[i - 1].record, &b = frames[i].record;
        const auto periods = static_cast<std::int64_t>(b.id - a.id);  // a loaded machine may skip some
        EXPECT_EQ(b.exposure_mid - a.exposure_mid, periods * 20 * kMs_ns) << i;
        EXPECT_GT(b.exposure_mid_monotonic_ns, a.exposure_mid_monotonic_ns);
        EXPECT_EQ(b.faults, 0u);
    }
}

// --- standing and stepping

TEST_F(PlateTest, WhileTimeStandsFramesOfTheStandingWorldKeepComing) {
    LoopRig rig(scenario(", frame_rate_hz: 50", "camera_pose: {velocity_m_s: [0.2, 0, 0]}\n"), {0, true},
                {"clock.paused=true"});
    rig.loop.start();
    ASSERT_TRUE(rig.collector.wait_for(5));
    const std::size_t standing = rig.collector.count();
    ASSERT_EQ(rig.send(step(100 * kMs_ns)), CommandStatus::kAccepted);
    const TimeTai end = rig.start + 100 * kMs_ns;
    for (int i = 0; i < 1000 && rig.clock.now() < end; ++i) sleep_ms(10);
    EXPECT_EQ(rig.clock.now(), end);
    ASSERT_TRUE(rig.collector.wait_for(rig.collector.count() + 5));
    rig.loop.stop();
    const auto& frames = rig.collector.frames;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const FrameRecord& r = frames[i].record;
        if (i > 0) {
            EXPECT_GT(r.id, frames[i - 1].record.id);
            const std::int64_t interval_ns =
                r.exposure_mid_monotonic_ns - frames[i - 1].record.exposure_mid_monotonic_ns;
            EXPECT_EQ(interval_ns % (20 * kMs_ns), 0) << i;  // the camera's rate, all the while
            EXPECT_LE(frames[i - 1].record.exposure_mid, r.exposure_mid);
        }
        EXPECT_LE(r.exposure_mid, end);
        // 200 mm/s: 32 px/s.
        const double at_s = static_cast<double>(r.exposure_mid - rig.start) * 1e-9;
        EXPECT_NEAR(mean_x(frames[i]), 32 - 32 * at_s, 0.2) << i;
        const bool stands = r.exposure_mid == rig.start || r.exposure_mid == end;
        EXPECT_EQ(r.faults, stands ? kTimeStandsBit : 0u) << i << " at " << at_s;
    }
    EXPECT_EQ(frames[standing - 1].record.exposure_mid, rig.start);
    EXPECT_EQ(frames.back().record.exposure_mid, end);
    EXPECT_GE(rig.loop.counters().standing.load(), 5u);
}

TEST_F(PlateTest, ACameraThatWaitsTakesTheFramesOfAStepAndNoMore) {
    // 200 ms of the machine's for each frame.
    LoopRig rig(scenario(", frame_rate_hz: 50"), {0, true},
                {"clock.paused=true", "clock.camera_in_pause=waits", "clock.scale=0.1"});
    rig.loop.start();
    sleep_ms(300);
    EXPECT_EQ(rig.collector.count(), 0u);
    ASSERT_EQ(rig.send(step(60 * kMs_ns)), CommandStatus::kAccepted);
    ASSERT_EQ(rig.send(step(40 * kMs_ns)), CommandStatus::kAccepted);
    ASSERT_TRUE(rig.collector.wait_for(5));
    sleep_ms(300);
    EXPECT_EQ(rig.collector.count(), 5u);
    rig.loop.stop();
    for (std::size_t i = 0; i < 5; ++i) {
        const FrameRecord& r = rig.collector.frames[i].record;
        EXPECT_EQ(r.exposure_mid - rig.start, (10 + 20 * static_cast<std::int64_t>(i)) * kMs_ns) << i;
        EXPECT_EQ(r.faults, 0u);
    }
}

// A simulator that tells a pose, lets time go on by a frame's period, and again: each frame shows the pose
// that came before its step, and the one at a step's end the pose of the next.
TEST_F(PlateTest, WhatIsToldWhileTheCameraWaitsCountsForTheFrameThatTimeGoesOnWith) {
    LoopRig rig(scenario(", frame_rate_hz: 50"), {0, true},
                {"clock.paused=true", "clock.camera_in_pause=waits"});
    rig.loop.start();
    for (std::size_t i = 1; i <= 4; ++i) {
        sleep_ms(100);
        ASSERT_EQ(rig.send(pose_at({}, 0.01 * static_cast<double>(i))), CommandStatus::kAccepted);
        ASSERT_EQ(rig.send(step(20 * kMs_ns)), CommandStatus::kAccepted);
        ASSERT_TRUE(rig.collector.wait_for(i));
    }
    sleep_ms(100);
    rig.loop.stop();
    ASSERT_EQ(rig.collector.count(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(rig.collector.frames[i].record.exposure_mid - rig.start,
                  (10 + 20 * static_cast<std::int64_t>(i)) * kMs_ns);
        EXPECT_EQ(rig.collector.frames[i].record.pose_sequence, 2 * i + 1) << i;
    }
}

TEST_F(PlateTest, AStandingWorldHasNoBlur) {
    LoopRig rig(scenario("", "camera_pose: {rate_deg_s: [0, 20, 0]}\n"), {1, false});
    RadianceImage radiance = rig.exposures.make_image();
    std::vector<PointSource> points;
    points.reserve(rig.exposures.max_points());
    Exposure exposure;
    exposure.exposure_s = 0.02;
    const auto rate = [&](double moving) {
        rig.exposures.render(rig.world, {rig.start, moving}, {1, 1}, radiance, points, exposure);
        return exposure.image_rate_px_s.x;
    };
    const double whole = rate(1);
    // 20 degrees a second at 640 px, to the side.
    EXPECT_NEAR(std::abs(whole), 640 * 20 * kDegree_rad, 0.02 * 640 * 20 * kDegree_rad);
    EXPECT_NEAR(rate(0.25) / whole, 0.25, 1e-3);
    EXPECT_EQ(rate(0), 0);
    EXPECT_EQ(length(exposure.camera_rate_rad_s), 0);
}

TEST_F(PlateTest, ATriggerWaitsForItsSimulatedInstantAlsoWhileTimeStands) {
    LoopRig rig(scenario(", frame_rate_hz: 50"), {0, true}, {"mode=triggered", "clock.paused=true"});
    rig.loop.start();
    ASSERT_EQ(rig.send(ExposeCommand{rig.start + 50 * kMs_ns, 1}), CommandStatus::kAccepted);
    sleep_ms(150);
    EXPECT_EQ(rig.collector.count(), 0u);
    ASSERT_EQ(rig.send(ClockCommand{Action::kResume, 0, 1, 0}), CommandStatus::kAccepted);
    ASSERT_TRUE(rig.collector.wait_for(1));
    EXPECT_EQ(rig.collector.frames[0].record.exposure_mid - rig.start, 60 * kMs_ns);
    // And on arrival it is taken of the standing world.
    ASSERT_EQ(rig.send(ClockCommand{Action::kPause, 0, 1, 0}), CommandStatus::kAccepted);
    ASSERT_EQ(rig.send(ExposeCommand{{}, 1}), CommandStatus::kAccepted);
    ASSERT_TRUE(rig.collector.wait_for(2));
    rig.loop.stop();
    EXPECT_EQ(rig.collector.frames[1].record.exposure_mid, rig.clock.now());
    EXPECT_EQ(rig.collector.frames[1].record.faults, kTimeStandsBit);
}

// --- when poses stop

// In lockstep: one pose at the start, 20 mm/s to the side, then frames 0.4, 1 and 2 s after it, then a new
// one.
std::vector<Collector::Frame> go_silent(const std::filesystem::path& file, const std::string& when_stale) {
    LoopRig rig(
        file, {},
        {"mode=lockstep", "commands.poses.stale_after_s=0.5", "commands.poses.when_stale=" + when_stale});
    rig.loop.start();
    EXPECT_EQ(rig.send(pose_at(rig.start, 0, 0.02)), CommandStatus::kAccepted);
    for (const std::int64_t at_ms : {400, 1000, 2000})
        EXPECT_EQ(rig.send(ExposeCommand{rig.start + at_ms * kMs_ns, 1}), CommandStatus::kAccepted);
    EXPECT_EQ(rig.send(pose_at(rig.start + 3000 * kMs_ns, 0)), CommandStatus::kAccepted);
    EXPECT_EQ(rig.send(ExposeCommand{rig.start + 3000 * kMs_ns, 1}), CommandStatus::kAccepted);
    EXPECT_TRUE(rig.collector.wait_for(4));
    EXPECT_EQ(rig.loop.counters().stale.load(), 2u);
    rig.loop.stop();
    constexpr std::array<std::int64_t, 4> kExpected_ms = {400, 1000, 2000, 3000};
    for (std::size_t i = 0; i < 4; ++i) {
        const FrameRecord& r = rig.collector.frames[i].record;
        EXPECT_EQ(r.faults, i == 1 || i == 2 ? kPosesStaleBit : 0u) << when_stale << i;
        EXPECT_EQ(r.exposure_mid - rig.start, kExpected_ms[i] * kMs_ns);
    }
    return std::move(rig.collector.frames);
}

TEST_F(PlateTest, WithoutPosesTheWorldMovesOnOrStandsOrIsDark) {
    const auto file = scenario();
    // 20 mm/s: 3.2 px/s.
    const auto moving = go_silent(file, "propagate"), held = go_silent(file, "hold"),
               black = go_silent(file, "black");
    for (const auto* frames : {&moving, &held, &black}) {
        EXPECT_NEAR(mean_x((*frames)[0]), 32 - 3.2 * 0.4, 0.2);
        EXPECT_NEAR(mean_x((*frames)[3]), 32, 0.2);
        EXPECT_EQ((*frames)[0].dn, moving[0].dn);
        EXPECT_EQ((*frames)[3].dn, moving[3].dn);
    }
    EXPECT_NEAR(mean_x(moving[1]), 32 - 3.2, 0.2);
    EXPECT_NEAR(mean_x(moving[2]), 32 - 6.4, 0.2);
    // Since 0.5 s, where they were then.
    EXPECT_NEAR(mean_x(held[1]), 32 - 1.6, 0.2);
    EXPECT_NEAR(mean_x(held[2]), 32 - 1.6, 0.2);
    for (const std::size_t i : {1u, 2u}) {
        // Offset 50 DN, read noise 5 e- at 0.2 DN/e-: 1 DN; six of them and the rounding.
        const auto [least, most] = std::minmax_element(black[i].dn.begin(), black[i].dn.end());
        EXPECT_GE(*least, 43);
        EXPECT_LE(*most, 57);
        EXPECT_LT(*least, *most);  // noise is there
        EXPECT_NE(black[1].dn, black[2].dn);
        EXPECT_EQ(black[i].record.pose_sequence, 0u);  // it shows none
    }
}

TEST_F(PlateTest, FramesStopWithoutPosesAndComeAgainWithThem) {
    LoopRig rig(scenario(", frame_rate_hz: 50"), {0, true},
                {"commands.poses.stale_after_s=0.2", "commands.poses.when_stale=stop"});
    rig.loop.start();
    ASSERT_TRUE(rig.collector.wait_for(15));  // 300 ms: before the first pose nothing is missed
    ASSERT_EQ(rig.send(pose_at({}, 0)), CommandStatus::kAccepted);
    for (int i = 0; i < 1000 && !rig.poses.stops(rig.clock.now()); ++i) sleep_ms(10);
    sleep_ms(500);  // what had begun is out
    const std::size_t stopped = rig.collector.count();
    sleep_ms(200);
    EXPECT_EQ(rig.collector.count(), stopped);
    ASSERT_TRUE(rig.settings.change({.triggered = true, .trigger_source = TriggerSource::kLine0}));
    EXPECT_EQ(rig.send(ExposeCommand{}), CommandStatus::kNotNow);
    ASSERT_TRUE(rig.settings.change({.triggered = false}));
    ASSERT_EQ(rig.send(pose_at({}, 0)), CommandStatus::kAccepted);
    EXPECT_TRUE(rig.collector.wait_for(stopped + 2));
    rig.loop.stop();
    for (const auto& f : rig.collector.frames) EXPECT_EQ(f.record.faults, 0u);
}

TEST_F(PlateTest, TheFirstFrameAfterTagsWentBackSaysSo) {
    LoopRig rig(scenario(), {}, {"mode=lockstep"});
    rig.loop.start();
    const auto at = [&](std::int64_t s) { return rig.start + s * 1000 * kMs_ns; };
    EXPECT_EQ(rig.send(pose_at(at(10), 0)), CommandStatus::kAccepted);
    EXPECT_EQ(rig.send(ExposeCommand{at(10), 1}), CommandStatus::kAccepted);
    EXPECT_EQ(rig.send(pose_at(at(5), 0.01)), CommandStatus::kAccepted);
    EXPECT_EQ(rig.send(ExposeCommand{at(11), 1}), CommandStatus::kAccepted);
    EXPECT_EQ(rig.send(ExposeCommand{at(12), 1}), CommandStatus::kAccepted);
    ASSERT_TRUE(rig.collector.wait_for(3));
    rig.loop.stop();
    const auto& frames = rig.collector.frames;
    EXPECT_EQ(frames[0].record.faults, 0u);
    EXPECT_EQ(frames[1].record.faults, kTagsWentBackBit);
    EXPECT_EQ(frames[2].record.faults, 0u);
    EXPECT_NEAR(mean_x(frames[1]), 32 - 1.6, 0.2);
}

}  // namespace
}  // namespace hilcam
