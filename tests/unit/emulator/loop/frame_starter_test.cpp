// Frames that begin late. The camera waits while simulated time stands, so that a test says how late it is.

#include "emulator/loop/frame_starter.h"

#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

#include <future>
#include <thread>

#include "emulator/loop/loop_parts.h"
#include "tests/support/plate.h"

namespace hilcam {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;

// What begins a loop's frames, without the loop: nobody asks for a frame but the test.
class StarterRig {
  public:
    LoopRig rig;

    explicit StarterRig(const std::filesystem::path& file, std::vector<std::string> overrides = {})
        : rig(file, {}, with_standing_clock(std::move(overrides))),
          starter_(rig.scenario.camera, rig.settings, rig.clock, {}),
          stands_ns_(rig.start.ns) {}

    std::int64_t stands_ns() const { return stands_ns_; }
    // Lets time go on until then.
    void go_to(std::int64_t camera_ns) {
        step(camera_ns - stands_ns_);
        while (rig.clock.camera_at(monotonic_ns()) < camera_ns)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    // A frame that is not due yet, and the first one in any case; the camera's time goes on in such steps until it begins.
    FrameStarter::Start first(std::int64_t step_ns = 1000) {
        auto frame = next_frame();
        while (frame.wait_for(std::chrono::milliseconds(10)) != std::future_status::ready) step(step_ns);
        return frame.get();
    }
    // The next frame, which has been due when time stands.
    FrameStarter::Start next() {
        auto frame = next_frame();
        if (frame.wait_for(std::chrono::minutes(1)) != std::future_status::ready) stopping_.store(true);
        EXPECT_FALSE(stopping_.load()) << "none is due";
        return frame.get();
    }

  private:
    FrameStarter starter_;
    std::atomic<bool> stopping_{false};
    std::int64_t stands_ns_;

    static std::vector<std::string> with_standing_clock(std::vector<std::string> overrides) {
        overrides.emplace_back("clock.paused=true");
        overrides.emplace_back("clock.camera_in_pause=waits");
        return overrides;
    }
    std::future<FrameStarter::Start> next_frame() {
        return std::async(std::launch::async, [&] {
            FrameStarter::Start start;
            starter_.next(0, stopping_, start);
            return start;
        });
    }
    void step(std::int64_t ns) {
        EXPECT_EQ(rig.send(ClockCommand{ClockCommand::Action::kStep, 0, 1, ns}), CommandStatus::kAccepted);
        stands_ns_ += ns;
    }
};

class FrameStarterTest : public PlateTest {};

TEST_F(FrameStarterTest, ALateExposureHasTheSettingsOfTheInstantItBeginsAt) {
    StarterRig bench(scenario(", frame_rate_hz: 50"));
    const std::int64_t first_ns = bench.first().camera_ns;
    bench.go_to(first_ns + 30 * kMillisecond_ns);
    ASSERT_EQ(bench.rig.send(SettingsCommand{{}, 6, {}}), CommandStatus::kAccepted);
    bench.go_to(first_ns + 35 * kMillisecond_ns);
    const FrameStarter::Start before = bench.next();
    EXPECT_EQ(before.camera_ns, first_ns + 20 * kMillisecond_ns);
    EXPECT_EQ(before.settings.gain_db, 0);
    bench.go_to(first_ns + 55 * kMillisecond_ns);
    const FrameStarter::Start after = bench.next();
    EXPECT_EQ(after.camera_ns, first_ns + 40 * kMillisecond_ns);
    EXPECT_EQ(after.settings.gain_db, 6);
}

// Not before that time where a frame is late, and not after it where the events are: here they happen all at once, when
// the exposure was due long ago.
TEST_F(FrameStarterTest, AnEventHoldsForExposuresThatBeginAtItsTimeOrLater) {
    constexpr std::int64_t kEach_ms = 5;
    std::string ramp = "events:\n";
    for (int i = 1; i <= 100; ++i)
        ramp +=
            fmt::format("  - {{at_s: {:.3f}, do: settings --gain-db {}}}\n", 1e-3 * kEach_ms * i, 0.1 * i);
    StarterRig bench(scenario(", frame_rate_hz: 50", ramp));
    LoopRig& rig = bench.rig;
    const auto gain_at = [&](std::int64_t camera_ns) {
        return 0.1 * static_cast<double>((camera_ns - rig.start.ns) / (kEach_ms * kMillisecond_ns));
    };
    const std::int64_t due_ns = bench.first().camera_ns + 20 * kMillisecond_ns;
    bench.go_to(due_ns + 15 * kMillisecond_ns);
    EventDirector events(EventSequence(rig.scenario.events, event_world(rig.scenario), rig.start),
                         {rig.dispatch, rig.settings, rig.clock, ShutterTiming(rig.scenario.camera),
                          rig.world.placed_objects(), false});
    events.start();
    ASSERT_NEAR(rig.settings.settings().gain_db, gain_at(bench.stands_ns()), 1e-9);
    const FrameStarter::Start late = bench.next();
    EXPECT_EQ(late.camera_ns, due_ns);
    EXPECT_NEAR(late.settings.gain_db, gain_at(due_ns), 1e-9);
}

TEST_F(FrameStarterTest, ALateTriggeredFrameHasThemToo) {
    StarterRig bench(scenario(", frame_rate_hz: 50"), {"mode=triggered"});
    const auto at_ms = [&](std::int64_t ms) { return bench.rig.start + ms * kMillisecond_ns; };
    ASSERT_EQ(bench.rig.send(ExposeCommand{at_ms(20), 2}), CommandStatus::kAccepted);
    bench.go_to(at_ms(30).ns);
    ASSERT_EQ(bench.rig.send(SettingsCommand{{}, 6, {}}), CommandStatus::kAccepted);
    bench.go_to(at_ms(55).ns);
    const double gain_db[] = {0, 6};
    for (std::int64_t i = 0; i < 2; ++i) {
        const FrameStarter::Start frame = bench.next();
        EXPECT_EQ(frame.camera_ns, at_ms(20 + 20 * i).ns);
        EXPECT_EQ(frame.settings.gain_db, gain_db[i]) << i;
    }
}

TEST_F(FrameStarterTest, ANewFrameRateLeavesAnExposureThatWasDueBeforeIt) {
    StarterRig bench(scenario(", frame_rate_hz: 50, frame_rate_range_hz: [1, 50]"));
    const std::int64_t first_ns = bench.first().camera_ns;
    bench.go_to(first_ns + 30 * kMillisecond_ns);
    ASSERT_EQ(bench.rig.send(SettingsCommand{{}, {}, 10}), CommandStatus::kAccepted);
    bench.go_to(first_ns + 35 * kMillisecond_ns);
    EXPECT_EQ(bench.next().camera_ns, first_ns + 20 * kMillisecond_ns);
    bench.go_to(first_ns + 130 * kMillisecond_ns);
    EXPECT_EQ(bench.next().camera_ns, first_ns + 120 * kMillisecond_ns);
}

// The exposure before it is missed; by the new rate the next one would have been before there was a new rate.
TEST_F(FrameStarterTest, NoExposureBeginsByARateThatCameAfterIt) {
    StarterRig bench(scenario(", frame_rate_hz: 50, frame_rate_range_hz: [1, 50]"));
    const std::int64_t first_ns = bench.first().camera_ns;
    bench.go_to(first_ns + 110 * kMillisecond_ns);
    ASSERT_EQ(bench.rig.send(SettingsCommand{{}, 6, 10}), CommandStatus::kAccepted);
    bench.go_to(first_ns + 135 * kMillisecond_ns);
    const FrameStarter::Start frame = bench.next();
    EXPECT_EQ(frame.camera_ns, first_ns + 110 * kMillisecond_ns);
    EXPECT_EQ(frame.settings.gain_db, 6);
}

TEST_F(FrameStarterTest, NoExposureBeginsWhileTheOneBeforeLasts) {
    StarterRig bench(scenario(", frame_rate_hz: 50"), {"camera.exposure_ms=210"});
    const std::int64_t first_ns = bench.first().camera_ns;
    bench.go_to(first_ns + 30 * kMillisecond_ns);
    ASSERT_EQ(bench.rig.send(SettingsCommand{0.001, {}, {}}), CommandStatus::kAccepted);
    bench.go_to(first_ns + 215 * kMillisecond_ns);
    const FrameStarter::Start shorter = bench.next();
    EXPECT_EQ(shorter.camera_ns, first_ns + 210 * kMillisecond_ns);
    EXPECT_EQ(shorter.exposure_s, 0.001);
    EXPECT_EQ(shorter.skipped, 0u);
    bench.go_to(first_ns + 235 * kMillisecond_ns);
    EXPECT_EQ(bench.next().camera_ns, first_ns + 230 * kMillisecond_ns);
}

TEST_F(FrameStarterTest, NorDoesATriggeredOneOrOneAfterIt) {
    StarterRig bench(scenario(", frame_rate_hz: 50"), {"camera.exposure_ms=200"});
    LiveSettings& settings = bench.rig.settings;
    const std::int64_t first_ns = bench.first().camera_ns;
    bench.go_to(first_ns + 30 * kMillisecond_ns);
    ASSERT_TRUE(settings.change({.triggered = true, .trigger_source = TriggerSource::kLine0}));
    ASSERT_EQ(bench.rig.send(ExposeCommand{}), CommandStatus::kAccepted);
    bench.go_to(first_ns + 205 * kMillisecond_ns);
    EXPECT_EQ(bench.next().camera_ns, first_ns + 200 * kMillisecond_ns);
    ASSERT_TRUE(settings.change({.triggered = false}));
    bench.go_to(first_ns + 300 * kMillisecond_ns);
    EXPECT_EQ(bench.first(5 * kMillisecond_ns).camera_ns, first_ns + 400 * kMillisecond_ns);
}

// Exposure and rate change between the trigger and the frame, or within a burst.
TEST_F(FrameStarterTest, TheCameraIsReadyWhenTheFramesThatItTookAreOver) {
    StarterRig bench(scenario(", frame_rate_hz: 50, frame_rate_range_hz: [1, 50]"),
                     {"mode=triggered", "camera.exposure_ms=200"});
    LoopRig& rig = bench.rig;
    std::int64_t now_ms = 0;
    const auto go_to_ms = [&](std::int64_t ms) {
        bench.go_to(rig.start.ns + ms * kMillisecond_ns);
        now_ms = ms;
    };
    const auto trigger = [&](std::int64_t after_ms, std::uint16_t frames = 1) {
        return rig.send(ExposeCommand{rig.start + (now_ms + after_ms) * kMillisecond_ns, frames});
    };
    ASSERT_EQ(trigger(20), CommandStatus::kAccepted);
    ASSERT_EQ(rig.send(SettingsCommand{0.001, {}, {}}), CommandStatus::kAccepted);
    go_to_ms(45);  // over at 40
    EXPECT_EQ(bench.next().exposure_s, 0.001);
    ASSERT_EQ(trigger(5), CommandStatus::kAccepted);
    ASSERT_EQ(rig.send(SettingsCommand{0.2, {}, {}}), CommandStatus::kAccepted);
    go_to_ms(55);
    EXPECT_EQ(bench.next().exposure_s, 0.2);
    EXPECT_EQ(trigger(190), CommandStatus::kBusy);  // over at 250
    ASSERT_EQ(rig.send(SettingsCommand{0.001, {}, 1}), CommandStatus::kAccepted);
    ASSERT_EQ(trigger(200, 3), CommandStatus::kAccepted);  // 255, 1255, 2255 ms
    go_to_ms(260);
    ASSERT_EQ(bench.next().exposure_s, 0.001);
    ASSERT_EQ(rig.send(SettingsCommand{{}, {}, 50}), CommandStatus::kAccepted);
    go_to_ms(1280);  // 1255, 1275
    ASSERT_FALSE(bench.next().ends_order);
    ASSERT_TRUE(bench.next().ends_order);
    EXPECT_EQ(trigger(10), CommandStatus::kBusy);  // over at 1295
    EXPECT_EQ(trigger(20), CommandStatus::kAccepted);
}

// The loop is busy with a frame from the stop to the next trigger.
TEST_F(FrameStarterTest, AStopDropsABurstThoughNobodyLooks) {
    StarterRig bench(scenario(", frame_rate_hz: 50, frame_rate_range_hz: [1, 50]"), {"mode=triggered"});
    LoopRig& rig = bench.rig;
    const auto at_ms = [&](std::int64_t ms) { return rig.start + ms * kMillisecond_ns; };
    ASSERT_EQ(rig.send(ExposeCommand{at_ms(20), 5}), CommandStatus::kAccepted);
    bench.go_to(at_ms(30).ns);
    EXPECT_EQ(bench.next().camera_ns, at_ms(20).ns);
    ASSERT_EQ(rig.send(ExposeCommand{at_ms(120), 5}), CommandStatus::kAccepted);
    ASSERT_EQ(rig.send(StopCommand{}), CommandStatus::kAccepted);
    ASSERT_EQ(rig.send(StartCommand{}), CommandStatus::kAccepted);
    EXPECT_EQ(rig.send(ExposeCommand{at_ms(35), 1}), CommandStatus::kBusy);  // of the frame, until 40
    ASSERT_EQ(rig.send(ExposeCommand{at_ms(50), 1}), CommandStatus::kAccepted);
    bench.go_to(at_ms(150).ns);
    const FrameStarter::Start frame = bench.next();
    EXPECT_EQ(frame.camera_ns, at_ms(50).ns);
    EXPECT_TRUE(frame.ends_order);
}

}  // namespace
}  // namespace hilcam
