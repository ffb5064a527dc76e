// Triggered cameras: what is taken, and what is missed.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <thread>
#include <vector>

#include "tests/support/plate.h"

namespace hilcam {
namespace {

TEST_F(FrameLoopTest, EveryTriggerGivesItsFramesAndEarlyOnesAreMissed) {
    LoopRig rig(scenario(", frame_rate_hz: 50, frame_rate_range_hz: [1, 50]"), {0, true}, {"mode=triggered"});
    std::vector<std::int64_t> missed;
    rig.settings.on_missed_trigger([&](std::int64_t ns) { missed.push_back(ns); });
    rig.loop.start();
    const std::int64_t t0 = monotonic_ns() + 50'000'000;
    const auto at = [&](std::int64_t ns) { return rig.clock.at(ns); };
    EXPECT_EQ(rig.send(expose(at(t0))), CommandStatus::kAccepted);
    EXPECT_EQ(rig.send(expose(at(t0 + 10'000'000))), CommandStatus::kBusy);  // 20 ms is the shortest period
    EXPECT_EQ(rig.send(expose(at(t0 + 20'000'000), 3)), CommandStatus::kAccepted);
    EXPECT_EQ(rig.send(expose(at(t0 + 79'000'000))), CommandStatus::kBusy);  // the burst lasts until 80 ms
    EXPECT_EQ(rig.send(expose(at(t0 + 80'000'000))), CommandStatus::kAccepted);
    EXPECT_EQ(missed.size(), 2u);
    ASSERT_TRUE(rig.collector.wait_for(5));
    rig.loop.stop();
    const std::int64_t begin_ms[] = {0, 20, 40, 60, 80};
    ASSERT_EQ(rig.collector.frames.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) {
        const FrameRecord& r = rig.collector.frames[i].record;
        EXPECT_EQ(r.id, i + 1);
        EXPECT_EQ(r.exposure_mid_monotonic_ns, t0 + begin_ms[i] * 1'000'000 + 10'000'000) << i;
    }
    const auto& events = rig.collector.events;
    const auto count = [&](CameraEvent::Kind kind) {
        return std::count_if(events.begin(), events.end(), [&](auto& e) { return e.kind == kind; });
    };
    EXPECT_EQ(count(CameraEvent::Kind::kExposureStart), 5);
    EXPECT_EQ(count(CameraEvent::Kind::kExposureEnd), 5);
    for (const CameraEvent& e : events) {
        if (e.kind == CameraEvent::Kind::kExposureEnd) {
            EXPECT_EQ(e.monotonic_ns, t0 + begin_ms[e.frame - 1] * 1'000'000 + 20'000'000);
        }
    }
}

// The picture is there long before the camera could take another one.
TEST_F(FrameLoopTest, WhoTriggersAtAFramesArrivalIsNeverTooEarly) {
    LoopRig rig(scenario(", frame_rate_hz: 100, frame_rate_range_hz: [1, 100]"), {0, true},
                {"mode=triggered", "camera.exposure_ms=1"});
    rig.loop.start();
    std::size_t frames = 0;
    const std::uint16_t bursts[] = {1, 1, 3, 1, 2, 1, 1, 1};
    for (const std::uint16_t burst : bursts) {
        EXPECT_EQ(rig.send(expose({}, burst)), CommandStatus::kAccepted) << "after " << frames;
        frames += burst;
        ASSERT_TRUE(rig.collector.wait_for(frames));
    }
    rig.loop.stop();
}

TEST_F(FrameLoopTest, WhatIsDroppedKeepsNoTriggerOut) {
    LoopRig rig(scenario(", frame_rate_hz: 50, frame_rate_range_hz: [1, 50]"), {0, true}, {"mode=triggered"});
    rig.loop.start();
    const auto in_ten_minutes = [&] { return rig.clock.at(monotonic_ns() + 600'000'000'000); };
    const auto is_taken = [&] {
        const std::int64_t until_ns = monotonic_ns() + 60'000'000'000;
        while (monotonic_ns() < until_ns) {
            if (rig.send(expose()) == CommandStatus::kAccepted) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    };
    ASSERT_EQ(rig.send(expose(in_ten_minutes())), CommandStatus::kAccepted);
    ASSERT_EQ(rig.send(expose()), CommandStatus::kBusy);
    ASSERT_TRUE(rig.settings.change({.running = false}));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    ASSERT_TRUE(rig.settings.change({.running = true}));
    EXPECT_TRUE(is_taken());
    ASSERT_TRUE(rig.collector.wait_for(1));
    rig.loop.stop();
}

// The frame is rendered when the pulse has ended, and shows its middle.
TEST_F(FrameLoopTest, APulsesWidthIsItsFramesExposure) {
    LoopRig rig(scenario(", frame_rate_hz: 50, frame_rate_range_hz: [1, 50], exposure_range_ms: [2, 100]"),
                {0, true}, {"mode=triggered"});
    ASSERT_TRUE(rig.settings.change({.exposure_mode = ExposureMode::kTriggerWidth}));
    rig.loop.start();
    const std::int64_t widths_us[] = {5'000, 40'000, 700, 300'000};
    const double exposures_s[] = {0.005, 0.04, 0.002, 0.1};
    std::vector<std::int64_t> begins_ns;
    for (const std::int64_t width_us : widths_us) {
        TriggerOrder order;
        order.source = TriggerSource::kLine0;
        order.at_monotonic_ns = monotonic_ns() - 1'000 * width_us;
        order.until_monotonic_ns = order.at_monotonic_ns + 1'000 * width_us;
        begins_ns.push_back(order.at_monotonic_ns);
        ASSERT_EQ(rig.settings.trigger(order), TriggerResult::kTaken) << width_us;
        ASSERT_TRUE(rig.collector.wait_for(begins_ns.size()));
        // The next pulse begins after this one's frame.
        std::this_thread::sleep_for(std::chrono::microseconds(width_us < 300'000 ? 350'000 : 0));
    }
    rig.loop.stop();
    ASSERT_EQ(rig.collector.frames.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        const FrameRecord& r = rig.collector.frames[i].record;
        EXPECT_DOUBLE_EQ(r.exposure_s, exposures_s[i]) << i;
        EXPECT_EQ(r.exposure_mid_monotonic_ns, begins_ns[i] + std::llround(0.5e9 * exposures_s[i])) << i;
    }
    // The longer exposure has more light.
    const auto light = [&](std::size_t i) {
        const auto& dn = rig.collector.frames[i].dn;
        return std::accumulate(dn.begin(), dn.end(), 0.0) - 50.0 * static_cast<double>(dn.size());
    };
    EXPECT_NEAR(light(1) / light(0), 8, 1);
    for (const CameraEvent& e : rig.collector.events)
        if (e.kind == CameraEvent::Kind::kExposureStart) {
            EXPECT_EQ(e.monotonic_ns, begins_ns[e.frame - 1]);
            EXPECT_EQ(e.end_ns, begins_ns[e.frame - 1] + std::llround(1e9 * exposures_s[e.frame - 1]));
        }
}

TEST_F(FrameLoopTest, SixtyFourTriggersWaitAndNoMore) {
    LoopRig rig(scenario(", frame_rate_hz: 50, frame_rate_range_hz: [1, 50]"), {0, true}, {"mode=triggered"});
    for (std::int64_t i = 1; i <= 64; ++i)
        ASSERT_EQ(rig.send(expose(rig.start + i * 1'000'000'000)), CommandStatus::kAccepted) << i;
    EXPECT_EQ(rig.send(expose(rig.start + 65'000'000'000)), CommandStatus::kBusy);
}

TEST_F(FrameLoopTest, AStopWithinAnExposureDeliversItsFrame) {
    LoopRig rig(scenario(", frame_rate_hz: 2, frame_rate_range_hz: [1, 50]"), {0, true},
                {"mode=triggered", "camera.exposure_ms=400"});
    rig.loop.start();
    ASSERT_EQ(rig.send(expose({}, 3)), CommandStatus::kAccepted);
    while (!rig.collector.has_event(CameraEvent::Kind::kExposureStart))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_EQ(rig.send(StopCommand{}), CommandStatus::kAccepted);
    EXPECT_TRUE(rig.collector.wait_for(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(700));  // the burst's next would have been there
    rig.loop.stop();
    ASSERT_EQ(rig.collector.frames.size(), 1u);
    EXPECT_EQ(rig.collector.frames[0].record.exposure_s, 0.4);
}

TEST_F(FrameLoopTest, ATriggeredCameraListensToItsSourceOnly) {
    LoopRig rig(scenario(), {0, true});
    EXPECT_EQ(rig.send(expose()), CommandStatus::kNotNow);  // free-run
    ASSERT_TRUE(rig.settings.change({.triggered = true}));
    EXPECT_EQ(rig.send(expose()), CommandStatus::kNotNow);  // Software is the default
    TriggerOrder order;
    EXPECT_EQ(rig.settings.trigger(order), TriggerResult::kTaken);
    ASSERT_TRUE(rig.settings.change({.trigger_source = TriggerSource::kAction1}));
    EXPECT_EQ(rig.settings.trigger(order), TriggerResult::kNotArmed);
    order.source = TriggerSource::kAction1;
    order.at_monotonic_ns = monotonic_ns() + 1'000'000'000;
    EXPECT_EQ(rig.settings.trigger(order), TriggerResult::kTaken);
    ASSERT_TRUE(rig.settings.change({.running = false}));
    EXPECT_EQ(rig.settings.trigger(order), TriggerResult::kNotArmed);
}

}  // namespace
}  // namespace hilcam
