#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <latch>
#include <limits>
#include <numeric>
#include <thread>

#include "tests/support/plate.h"

namespace hilcam {
namespace {

ExposeCommand expose(TimeTai time = {}, std::uint16_t frames = 0) { return {time, frames}; }

class FrameLoopTest : public PlateTest {};

// --- lockstep

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

// A run waits for its loop's end while somebody else ends it.
TEST_F(FrameLoopTest, TwoThreadsMayStopItAtOnce) {
    for (int i = 0; i < 8; ++i) {
        LoopRig rig(scenario(", frame_rate_hz: 10"), {}, {"mode=lockstep"});
        rig.loop.start();
        std::latch both(2);
        const auto stop = [&] {
            both.arrive_and_wait();
            rig.loop.stop();
            EXPECT_TRUE(rig.loop.finished());
        };
        std::thread other(stop);
        stop();
        other.join();
    }
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

// A rolling shutter sees two that fly together as it sees two at rest, at a satellite's speed, too: to the
// rounding of single precision, and to numbers that noise rounds the other way.
TEST_F(FrameLoopTest, RowsMoveAgainstWhatIsSeen) {
    const auto file =
        scenario(", frame_rate_hz: 10, shutter: {kind: rolling, line_time_us: 100}", "mode: lockstep\n");
    const auto picture = [&](double speed_m_s) {
        LoopRig rig(file, {1});
        PoseCommand pose;
        pose.motion.time = rig.start;
        pose.motion.velocity_world_m_s = {0, speed_m_s, 0};
        EXPECT_EQ(rig.send(pose), CommandStatus::kAccepted);
        pose.object = 1, pose.motion.pose.position_world_m = {0, 0, 4};
        EXPECT_EQ(rig.send(pose), CommandStatus::kAccepted);
        rig.loop.start();
        EXPECT_EQ(rig.send(ExposeCommand{rig.start + 1'000'000'000, 1}), CommandStatus::kAccepted);
        EXPECT_TRUE(rig.collector.wait_for(1));
        rig.loop.stop();
        return std::move(rig.collector.frames.at(0).dn);
    };
    const std::vector<std::uint16_t> at_rest = picture(0), in_orbit = picture(7600);
    std::size_t different = 0, lit = 0;
    for (std::size_t i = 0; i < at_rest.size(); ++i) {
        if (at_rest[i] > 500) ++lit;
        if (std::abs(at_rest[i] - in_orbit[i]) > 2) ++different;
    }
    EXPECT_GT(lit, 150u);  // 16 x 16 px
    EXPECT_LT(different, 5u);
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
        // As above: with what was known before, the pose would be a mixture.
        EXPECT_NEAR(plate_x_px(rig.collector.frames[i]), 32 - 1.6 * static_cast<double>(i), 0.2) << i;
    }
}

// --- the end of a run

// The picture of an exposure is there when that is over: a run that ends before it has none.
TEST_F(FrameLoopTest, NoFrameIsPublishedBeforeItsExposureIsOver) {
    class Watch : public Collector {
      public:
        std::atomic<std::int64_t> least_late_ns{std::numeric_limits<std::int64_t>::max()};
        void publish(const DnImage& frame, const FrameRecord& record) noexcept override {
            const std::int64_t end_ns = record.exposure_mid_monotonic_ns + 200'000'000;
            least_late_ns = std::min(least_late_ns.load(), monotonic_ns() - end_ns);
            Collector::publish(frame, record);
        }
    };
    for (const std::uint64_t limit : {0u, 2u}) {
        LoopRig rig(scenario(", frame_rate_hz: 2"), {}, {"camera.exposure_ms=400"});
        Watch watch;
        LoopParts parts = rig.parts({limit, 0, true});
        parts.sinks = {&watch};
        FrameLoop loop(parts);
        loop.start();
        if (limit == 0) {
            ASSERT_TRUE(watch.wait_for(1));
            // Within the exposure of the second, which begins 500 ms after the first.
            std::this_thread::sleep_for(std::chrono::milliseconds(300));
        }
        while (limit > 0 && !loop.finished()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        loop.stop();
        EXPECT_EQ(watch.count(), limit == 0 ? 1u : limit);
        EXPECT_EQ(loop.counters().frames.load(), watch.count());
        EXPECT_GE(watch.least_late_ns.load(), -1000) << limit;
    }
}

// --- triggers

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

// --- live settings

TEST_F(FrameLoopTest, BinnedLiveAFrameIsWhatACameraBinnedByItsFileTakes) {
    const auto take = [&](const std::string& camera, std::int64_t binning) {
        LoopRig rig(scenario(camera), {1, false});
        EXPECT_TRUE(rig.settings.change({.binning_x = binning, .binning_y = binning}));
        rig.loop.start();
        EXPECT_TRUE(rig.collector.wait_for(1));
        rig.loop.stop();
        return std::move(rig.collector.frames[0]);
    };
    for (const char* kind : {"charge", "sum", "mean"}) {
        const std::string binning = std::string(", binning: ") + kind;
        const auto live = take(binning, 2), filed = take(binning + ", binning_x: 2, binning_y: 2", 2);
        EXPECT_EQ(live.width, 32);
        EXPECT_EQ(live.dn, filed.dn) << kind;
        EXPECT_EQ(live.record.binning_x, 2);
        EXPECT_EQ(take(binning + ", binning_x: 2, binning_y: 2", 1).width, 64);
    }
}

TEST_F(FrameLoopTest, SettingsBelongToTheFrameThatTheyWereTakenWith) {
    LoopRig rig(scenario(), {0, false});
    rig.loop.start();
    ASSERT_TRUE(rig.collector.wait_for(3));
    ASSERT_TRUE(rig.settings.change(
        {.exposure_s = 0.01, .gain_db = 6, .black_level_dn = 200, .test_pattern = TestPattern::kWhite}));
    ASSERT_TRUE(rig.collector.wait_for(rig.loop.counters().frames.load() + 8));
    rig.loop.stop();
    std::size_t white = 0;
    for (const auto& f : rig.collector.frames) {
        const bool is_white = std::all_of(f.dn.begin(), f.dn.end(), [](auto dn) { return dn == 4095; });
        EXPECT_EQ(is_white, f.record.gain_db == 6) << f.record.id;
        EXPECT_EQ(f.record.exposure_s, is_white ? 0.01 : 0.02);
        EXPECT_EQ(f.record.black_level_dn, is_white ? 200 : 50);
        white += is_white;
    }
    EXPECT_GE(white, 5u);
}

TEST_F(FrameLoopTest, ANewFrameRateHoldsFromTheLastFrameOn) {
    LoopRig rig(scenario(", frame_rate_hz: 20"), {0, true});
    rig.loop.start();
    ASSERT_TRUE(rig.collector.wait_for(4));
    ASSERT_TRUE(rig.settings.change({.frame_rate_hz = 5}));
    ASSERT_TRUE(rig.collector.wait_for(7));
    ASSERT_TRUE(rig.settings.change({.frame_rate_hz = 50}));
    ASSERT_TRUE(rig.collector.wait_for(11));
    rig.loop.stop();
    const auto& frames = rig.collector.frames;
    for (std::size_t i = 1; i < frames.size(); ++i) {
        const std::int64_t interval_ns =
            frames[i].record.exposure_mid_monotonic_ns - frames[i - 1].record.exposure_mid_monotonic_ns;
        // Whole periods (a loaded machine may skip some) of one of the three rates; at a change to a faster
        // one the frame may begin when the change comes.
        const auto whole = [&](std::int64_t period_ns) { return interval_ns % period_ns == 0; };
        const bool known = whole(50'000'000) || whole(200'000'000) || whole(20'000'000);
        EXPECT_TRUE(known || (i >= 6 && interval_ns < 200'000'000)) << i << ": " << interval_ns;
    }
}

TEST_F(FrameLoopTest, BlackLevelAndReversalAreThoseAskedFor) {
    const auto take = [&](const SettingsChange& change) {
        LoopRig rig(scenario(), {1, false});
        EXPECT_TRUE(rig.settings.change(change));
        rig.loop.start();
        EXPECT_TRUE(rig.collector.wait_for(1));
        rig.loop.stop();
        return std::move(rig.collector.frames[0].dn);
    };
    const auto plain = take({}), brighter = take({.black_level_dn = 150}),
               mirrored = take({.reverse_x = true}), turned = take({.reverse_x = true, .reverse_y = true});
    for (std::size_t y = 0; y < 64; ++y)
        for (std::size_t x = 0; x < 64; ++x) {
            const auto at = [&](const auto& dn, std::size_t i, std::size_t j) { return dn[64 * j + i]; };
            // Rounded from a value that is 100 higher; up to the converter's end.
            EXPECT_EQ(at(brighter, x, y), std::min(4095, at(plain, x, y) + 100));
            EXPECT_EQ(at(mirrored, x, y), at(plain, 63 - x, y));
            EXPECT_EQ(at(turned, x, y), at(plain, 63 - x, 63 - y));
        }
}

TEST_F(FrameLoopTest, WhatDoesNotFitChangesNothing) {
    LoopRig rig(scenario(), {1, false});
    EXPECT_FALSE(rig.settings.change({.exposure_s = 0.01, .binning_x = 3}));
    EXPECT_FALSE(rig.settings.change({.exposure_s = 0.01, .black_level_dn = 4000}));
    EXPECT_FALSE(rig.settings.change({.exposure_s = 0.01, .burst_frames = 0}));
    EXPECT_FALSE(rig.settings.change({.automatic_exposure = true, .trigger_delay_s = -1}));
    EXPECT_EQ(rig.settings.settings().exposure_s, 0.02);
    EXPECT_FALSE(rig.settings.settings().automatic_exposure);
    EXPECT_TRUE(rig.settings.change({.automatic_exposure = true}));
    EXPECT_FALSE(rig.settings.change({.exposure_s = 0.01}));  // the camera's own now
    EXPECT_TRUE(rig.settings.change({.exposure_s = 0.01, .automatic_exposure = false}));
    LiveSettings fixed(rig.scenario.camera, {.fixed_size = true});
    EXPECT_FALSE(fixed.change({.binning_x = 2}));
    EXPECT_FALSE(LiveSettings(CameraModel{}, {.lockstep = true}).change({.triggered = false}));
}

// --- faults of the picture

TEST_F(FrameLoopTest, FaultsStrikeTheFramesTheyAreOrderedFor) {
    LoopRig rig(scenario(), {8, 0, false});
    const auto order = [&](FaultKind kind, std::uint64_t frame, double rate = 1, double value = 0) {
        EXPECT_EQ(rig.send(FaultCommand{{kind, rate, value, frame, 1, 0}, false}), CommandStatus::kAccepted);
    };
    order(FaultKind::kImageBlack, 2);
    order(FaultKind::kImageSaturated, 3);
    order(FaultKind::kImageStuck, 5);
    order(FaultKind::kImageTear, 6, 1, 0.5);
    order(FaultKind::kImageBitFlips, 7, 0.01);
    rig.loop.start();
    ASSERT_TRUE(rig.collector.wait_for(8));
    rig.loop.stop();
    LoopRig whole(scenario(), {8, 0, false});
    // The same instants, so that the pictures compare: nothing moves, and noise is keyed by the frame.
    whole.loop.start();
    ASSERT_TRUE(whole.collector.wait_for(8));
    whole.loop.stop();
    const auto& struck = rig.collector.frames;
    const auto& right = whole.collector.frames;
    for (const std::size_t i : {0u, 3u, 7u}) {
        EXPECT_EQ(struck[i].dn, right[i].dn) << i;
        EXPECT_EQ(struck[i].record.faults, 0u) << i;
    }
    EXPECT_EQ(std::accumulate(struck[1].dn.begin(), struck[1].dn.end(), 0u), 0u);
    EXPECT_EQ(struck[1].record.faults, bit_of(FaultKind::kImageBlack));
    EXPECT_TRUE(std::all_of(struck[2].dn.begin(), struck[2].dn.end(), [](auto dn) { return dn == 4095; }));
    EXPECT_EQ(struck[4].dn, right[3].dn);
    EXPECT_TRUE(std::equal(struck[5].dn.begin(), struck[5].dn.begin() + 32 * 64, right[5].dn.begin()));
    EXPECT_TRUE(
        std::equal(struck[5].dn.begin() + 32 * 64, struck[5].dn.end(), right[3].dn.begin() + 32 * 64));
    int flipped = 0;
    for (std::size_t i = 0; i < 64 * 64; ++i)
        if (const unsigned bits = struck[6].dn[i] ^ right[6].dn[i]; bits != 0) {
            EXPECT_EQ(bits & (bits - 1), 0u);  // one bit
            ++flipped;
        }
    // Binomial, 4096 pixels at 1 %: 41 with a standard deviation of 6.4; five of them.
    EXPECT_NEAR(flipped, 41, 32);
    EXPECT_EQ(rig.faults.strikes_of(FaultKind::kImageBitFlips), static_cast<std::uint64_t>(flipped));
    EXPECT_EQ(rig.send(FaultCommand{{FaultKind::kImageTear, 1, 2, 0, 0, 0}, false}),
              CommandStatus::kBadArgument);
}

}  // namespace
}  // namespace hilcam
