#include "emulator/loop/live_settings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/plate.h"

namespace hilcam {
namespace {

TEST(LiveSettings, RefusesWhatIsOutsideAndTheLoopSeesTheRest) {
    CameraModel camera;
    LiveSettings settings(camera);
    EXPECT_FALSE(settings.change({.exposure_s = 1e9}));
    EXPECT_FALSE(settings.change({.gain_db = std::nan("")}));
    EXPECT_TRUE(settings.change({.gain_db = 6}));
    EXPECT_EQ(settings.read_in_loop().gain_db, 6);
}

TEST(LiveSettings, AWidthNeedsAPulseAndAnExposureThatIsNotTheCameras) {
    LiveSettings settings(CameraModel{});
    ASSERT_TRUE(settings.change({.exposure_mode = ExposureMode::kTriggerWidth}));
    EXPECT_FALSE(settings.change({.automatic_exposure = true}));
    EXPECT_FALSE(settings.change({.trigger_activation = TriggerActivation::kAnyEdge}));
    EXPECT_TRUE(settings.change({.trigger_activation = TriggerActivation::kFallingEdge}));
    EXPECT_FALSE(settings.change({.trigger_divider = 0}));
    EXPECT_FALSE(settings.change({.trigger_divider = 65536}));
    LiveSettings lockstep(CameraModel{}, {.lockstep = true});
    EXPECT_FALSE(lockstep.change({.exposure_mode = ExposureMode::kTriggerWidth}));
    CameraModel stepping;
    stepping.sequence.resize(2);
    EXPECT_FALSE(LiveSettings(stepping).change({.exposure_mode = ExposureMode::kTriggerWidth}));
}

TEST(LiveSettings, LevelsNeedRealTimeAndHaveNoWidth) {
    LiveSettings settings(CameraModel{});
    ASSERT_TRUE(settings.change({.trigger_activation = TriggerActivation::kLevelHigh}));
    EXPECT_FALSE(settings.change({.exposure_mode = ExposureMode::kTriggerWidth}));
    LiveSettings lockstep(CameraModel{}, {.lockstep = true});
    EXPECT_FALSE(lockstep.change({.trigger_activation = TriggerActivation::kLevelLow}));
}

TEST(LiveSettings, ASequencerExcludesAutomaticExposureAndASequenceOfTheCamerasOwn) {
    LiveSettings settings(CameraModel{});
    ASSERT_NE(settings.sequencer(), nullptr);
    settings.sequencer()->start({});
    EXPECT_FALSE(settings.change({.automatic_exposure = true}));
    settings.sequencer()->stop();
    EXPECT_TRUE(settings.change({.automatic_exposure = true}));
    CameraModel stepping;
    stepping.sequence.resize(2);
    EXPECT_EQ(LiveSettings(stepping).sequencer(), nullptr);
}

// Highest rate 50 Hz. The trigger that waits may get the set of 90 ms, so the next one is too early until that is over.
TEST(LiveSettings, WhileATriggerWaitsTheLongestExposureOfTheSetsCounts) {
    CameraModel camera;
    camera.frame_rate_range_hz = {1, 50};
    camera.exposure_s = 0.001;
    LiveSettings settings(camera, {.triggered = true});
    SequencerProgram program;
    program.sets[0] = {.exposure_s = 0.002, .paths = {{{1, LineEvent::kFrameStart}}}};
    program.sets[1].exposure_s = 0.09;
    settings.sequencer()->start(program);
    TriggerOrder order;
    order.source = TriggerSource::kLine0;
    order.at_monotonic_ns = monotonic_ns();
    ASSERT_EQ(settings.trigger(order), TriggerResult::kTaken);
    EXPECT_EQ(settings.trigger_ready_ns(), order.at_monotonic_ns + 90'000'000);
    settings.change({.triggered = false});
}

// Highest rate 50 Hz, exposure 30 ms: with ReadOut the camera is ready 30 ms after a trigger, with Off 50 ms.
TEST(LiveSettings, WithoutOverlapATriggerWaitsForTheReadout) {
    for (const TriggerOverlap overlap : {TriggerOverlap::kReadOut, TriggerOverlap::kOff}) {
        CameraModel camera;
        camera.frame_rate_range_hz = {1, 50};
        camera.exposure_s = 0.03;
        LiveSettings settings(camera, {.triggered = true});
        EXPECT_EQ(settings.trigger_ready_ns(), 0);
        ASSERT_TRUE(settings.change({.trigger_overlap = overlap}));
        TriggerOrder order;
        order.source = TriggerSource::kLine0;
        order.at_monotonic_ns = monotonic_ns();
        ASSERT_EQ(settings.trigger(order), TriggerResult::kTaken);
        const std::int64_t length_ns = overlap == TriggerOverlap::kReadOut ? 30'000'000 : 50'000'000;
        EXPECT_EQ(settings.trigger_ready_ns(), order.at_monotonic_ns + length_ns);
        TriggerOrder next = order;
        next.at_monotonic_ns += length_ns - 1;
        EXPECT_EQ(settings.trigger(next), TriggerResult::kMissed);
        next.at_monotonic_ns += 1;
        EXPECT_EQ(settings.trigger(next), TriggerResult::kTaken);
        settings.change({.triggered = false});
        EXPECT_EQ(settings.trigger_ready_ns(), CameraControl::kNeverReady_ns);
    }
}

TEST(LiveSettings, ATriggersExposureIsToldAtOnceAndTakenBackByAStop) {
    CameraModel camera;
    camera.exposure_s = 0.03;
    LiveSettings settings(camera, {.triggered = true});
    std::vector<std::pair<std::int64_t, std::int64_t>> told;
    settings.on_exposure(
        [&](std::int64_t begin_ns, std::int64_t end_ns) { told.emplace_back(begin_ns, end_ns); });
    ASSERT_TRUE(settings.change({.trigger_delay_s = 0.5}));
    TriggerOrder order;
    order.source = TriggerSource::kLine0;
    order.at_monotonic_ns = monotonic_ns();
    ASSERT_EQ(settings.trigger(order), TriggerResult::kTaken);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0].first, order.at_monotonic_ns + 500'000'000);
    EXPECT_EQ(told[0].second, order.at_monotonic_ns + 530'000'000);
    EXPECT_EQ(settings.trigger(order), TriggerResult::kMissed);
    EXPECT_EQ(told.size(), 1u);
    ASSERT_TRUE(settings.change({.running = false}));
    ASSERT_EQ(told.size(), 2u);
    EXPECT_EQ(told[1].first, 0);
}

TEST(SettingsHistory, EachHoldFromTheirInstantOnAndTheOldestBeforeAll) {
    SettingsHistory history(CameraSettings{.gain_db = -1});
    EXPECT_EQ(history.at(0).gain_db, -1);
    for (int i = 0; i < 20; ++i) history.add({.gain_db = 1.0 * i}, 10 * i);
    EXPECT_EQ(history.newest().gain_db, 19);
    EXPECT_EQ(history.at(189).gain_db, 18);
    EXPECT_EQ(history.at(190).gain_db, 19);
    EXPECT_EQ(history.at(0).gain_db, 4);  // 16 are kept
    history.add({.gain_db = 20}, 5);      // not before those that were there
    EXPECT_EQ(history.at(189).gain_db, 18);
    EXPECT_EQ(history.at(190).gain_db, 20);
}

// An order that comes just when the loop has looked for the last time, as at the end of --frames.
TEST(LiveSettings, NobodyWaitsForALoopThatHasEnded) {
    LiveSettings settings(CameraModel{}, {.lockstep = true});
    TriggerOrder order;
    order.source = TriggerSource::kLine0;
    ASSERT_EQ(settings.order_in_lockstep(order), TriggerResult::kTaken);
    settings.close();
    EXPECT_TRUE(settings.wait_for_order(5)) << "the whole patience";
}

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

}  // namespace
}  // namespace hilcam
