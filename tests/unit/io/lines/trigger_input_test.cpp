#include "io/lines/trigger_input.h"

#include <gtest/gtest.h>

#include "wired_camera.h"

namespace hilcam {
namespace {

struct Input {
    WiredCamera camera;
    std::vector<TriggerInput::Exposure> exposures;
    TriggerInput input{camera, [this](const TriggerInput::Exposure& e) { exposures.push_back(e); }};
    std::uint32_t sequence = 0;

    void edge(bool level, std::int64_t at_us, std::uint8_t line = 0) {
        input.edge({line, level, at_us * kMicrosecond_ns, ++sequence});
    }
    void pulses(int count, std::int64_t from_us = 0) {
        for (int i = 0; i < count; ++i) {
            edge(true, from_us + 100 * i);
            edge(false, from_us + 100 * i + 50);
        }
    }
    std::vector<std::int64_t> times_us() const {
        std::vector<std::int64_t> out;
        for (const TriggerOrder& order : camera.orders)
            out.push_back(order.at_monotonic_ns / kMicrosecond_ns);
        return out;
    }
};
using Times = std::vector<std::int64_t>;

TEST(TriggerInput, TheActiveEdgeIsTheTrigger) {
    const struct {
        TriggerActivation activation;
        Times times_us;
    } cases[] = {{TriggerActivation::kRisingEdge, {0, 100}},
                 {TriggerActivation::kFallingEdge, {50, 150}},
                 {TriggerActivation::kAnyEdge, {0, 50, 100, 150}}};
    for (const auto& c : cases) {
        Input in;
        in.camera.s.trigger_activation = c.activation;
        in.pulses(2);
        EXPECT_EQ(in.times_us(), c.times_us);
    }
    Input in;
    in.pulses(2);
    EXPECT_EQ(in.camera.orders[1].sequence, 3u);  // the edge's
    EXPECT_EQ(in.camera.orders[1].until_monotonic_ns, 0);
}

TEST(TriggerInput, TheDividerTakesTheLastOfSoManyEdges) {
    Input in;
    in.camera.s.trigger_divider = 3;
    in.pulses(7);
    EXPECT_EQ(in.times_us(), (Times{200, 500}));
    in.camera.s.trigger_divider = 2;  // counts anew: the seventh edge before it does not count
    in.pulses(2, 1000);
    EXPECT_EQ(in.times_us(), (Times{200, 500, 1100}));
}

// 30 frames a second, each a period after the one before; none at the instant at which the level ends.
TEST(TriggerInput, FramesFollowOneAnotherWhileALevelHolds) {
    for (const bool high : {true, false}) {
        Input in;
        in.camera.s.trigger_activation = high ? TriggerActivation::kLevelHigh : TriggerActivation::kLevelLow;
        in.camera.s.frame_rate_hz = 1000;
        in.camera.s.trigger_divider = 3;  // counts edges, and there are none between frames
        in.edge(high, 500);
        EXPECT_TRUE(in.times_us().empty());
        while (in.input.wake_ns() < 3500 * kMicrosecond_ns) in.input.tick(in.input.wake_ns());
        EXPECT_EQ(in.times_us(), (Times{500, 1500, 2500}));
        EXPECT_EQ(in.camera.orders[2].sequence, 1u);  // the edge's that began the level
        in.edge(!high, 3500);
        EXPECT_EQ(in.input.wake_ns(), CameraControl::kNeverReady_ns);
    }
}

TEST(TriggerInput, ALevelWaitsForTheCameraAndMissesNothing) {
    Input in;
    in.camera.s.trigger_activation = TriggerActivation::kLevelHigh;
    in.camera.ready_ns = 700 * kMicrosecond_ns;
    in.edge(true, 500);
    in.input.tick(500 * kMicrosecond_ns);
    EXPECT_TRUE(in.camera.orders.empty());
    in.input.tick(in.input.wake_ns());
    EXPECT_EQ(in.times_us(), (Times{700}));
}

TEST(TriggerInput, ALevelThatHeldBeforeTheCameraListenedCounts) {
    Input in;
    std::array<bool, kLines> levels{};
    levels[2] = true;
    in.input.follow(levels, 100 * kMicrosecond_ns);
    EXPECT_FALSE(in.input.watches_level());
    in.camera.s.trigger_activation = TriggerActivation::kLevelHigh;
    in.input.follow(levels, 200 * kMicrosecond_ns);  // Line0 is low
    EXPECT_TRUE(in.input.watches_level());
    EXPECT_EQ(in.input.wake_ns(), CameraControl::kNeverReady_ns);
    in.camera.s.trigger_source = TriggerSource::kLine2;
    in.input.follow(levels, 300 * kMicrosecond_ns);
    in.input.tick(300 * kMicrosecond_ns);
    EXPECT_EQ(in.times_us(), (Times{300}));
    in.camera.s.triggered = false;
    in.input.follow(levels, 400 * kMicrosecond_ns);
    EXPECT_EQ(in.input.wake_ns(), CameraControl::kNeverReady_ns);
}

TEST(TriggerInput, AnExposePulseIsOneFrameOfAHighLevelAndNoneOfALowOne) {
    Input in;
    TriggerOrder order;
    order.source = TriggerSource::kLine0;
    in.camera.s.trigger_activation = TriggerActivation::kLevelHigh;
    EXPECT_EQ(in.input.pulse(order), TriggerResult::kTaken);
    EXPECT_EQ(in.camera.orders.size(), 1u);
    in.camera.s.trigger_activation = TriggerActivation::kLevelLow;
    EXPECT_EQ(in.input.pulse(order), TriggerResult::kTaken);
    EXPECT_EQ(in.camera.orders.size(), 1u);
}

TEST(TriggerInput, OtherLinesAndOtherSourcesDoNotTrigger) {
    Input in;
    in.edge(true, 0, 2);
    EXPECT_TRUE(in.camera.orders.empty());
    in.camera.s.trigger_source = TriggerSource::kLine2;
    in.edge(true, 10, 2);
    in.edge(true, 20, 0);
    EXPECT_EQ(in.times_us(), (Times{10}));
    EXPECT_EQ(in.camera.orders[0].source, TriggerSource::kLine2);
    in.camera.s.triggered = false;
    in.edge(true, 30, 2);
    EXPECT_EQ(in.camera.orders.size(), 1u);
}

TEST(TriggerInput, ThePulsesWidthIsTheExposure) {
    Input in;
    in.camera.s.exposure_mode = ExposureMode::kTriggerWidth;
    in.camera.s.trigger_delay_s = 20e-6;
    in.edge(true, 100);
    EXPECT_TRUE(in.camera.orders.empty());  // how long it will be is not known
    ASSERT_EQ(in.exposures.size(), 1u);
    EXPECT_EQ(in.exposures[0].begin_ns, 120 * kMicrosecond_ns);
    EXPECT_EQ(in.exposures[0].end_ns, 0);
    in.edge(false, 2100);
    ASSERT_EQ(in.camera.orders.size(), 1u);
    EXPECT_EQ(in.camera.orders[0].at_monotonic_ns, 100 * kMicrosecond_ns);
    EXPECT_EQ(in.camera.orders[0].until_monotonic_ns, 2100 * kMicrosecond_ns);
    EXPECT_EQ(in.camera.orders[0].sequence, 1u);
    ASSERT_EQ(in.exposures.size(), 2u);
    EXPECT_EQ(in.exposures[1].end_ns, 2120 * kMicrosecond_ns);
    EXPECT_FALSE(in.exposures[1].lost);
}

TEST(TriggerInput, AWidthOfTheFallingEdgeLastsWhileTheLineIsLow) {
    Input in;
    in.camera.s.exposure_mode = ExposureMode::kTriggerWidth;
    in.camera.s.trigger_activation = TriggerActivation::kFallingEdge;
    in.pulses(2);
    ASSERT_EQ(in.camera.orders.size(), 1u);
    EXPECT_EQ(in.camera.orders[0].at_monotonic_ns, 50 * kMicrosecond_ns);
    EXPECT_EQ(in.camera.orders[0].until_monotonic_ns, 100 * kMicrosecond_ns);
}

TEST(TriggerInput, TheLongestExposureEndsALongerPulse) {
    Input in;
    in.camera.s.exposure_mode = ExposureMode::kTriggerWidth;
    EXPECT_EQ(in.input.wake_ns(), CameraControl::kNeverReady_ns);
    in.edge(true, 1000);
    EXPECT_EQ(in.input.wake_ns(), 501 * kMilli_ns);
    in.input.tick(501 * kMilli_ns - 1);
    EXPECT_TRUE(in.camera.orders.empty());
    in.input.tick(502 * kMilli_ns);
    ASSERT_EQ(in.camera.orders.size(), 1u);
    EXPECT_EQ(in.camera.orders[0].until_monotonic_ns, 501 * kMilli_ns);
    in.edge(false, 600'000);  // has no exposure to end
    EXPECT_EQ(in.camera.orders.size(), 1u);
    EXPECT_EQ(in.exposures.size(), 2u);
}

TEST(TriggerInput, APulseThatComesTooEarlyIsNotShownAndIsMissedAtItsEnd) {
    Input in;
    in.camera.s.exposure_mode = ExposureMode::kTriggerWidth;
    in.camera.ready_ns = 200 * kMicrosecond_ns;
    in.camera.result = TriggerResult::kMissed;
    in.edge(true, 100);
    in.edge(false, 300);
    EXPECT_TRUE(in.exposures.empty());
    EXPECT_EQ(in.camera.orders.size(), 1u);
}

TEST(TriggerInput, AStopWithinAPulseEndsItsExposureWithoutAFrame) {
    Input in;
    in.camera.s.exposure_mode = ExposureMode::kTriggerWidth;
    in.edge(true, 100);
    in.camera.result = TriggerResult::kNotArmed;
    in.edge(false, 300);
    ASSERT_EQ(in.exposures.size(), 2u);
    EXPECT_TRUE(in.exposures[1].lost);
    EXPECT_EQ(in.exposures[1].end_ns, 300 * kMicrosecond_ns);
}

TEST(TriggerInput, AnExposePulseTriggersAsTheInputSays) {
    Input in;
    TriggerOrder order;
    order.source = TriggerSource::kLine0, order.at_monotonic_ns = kMilli_ns, order.sequence = 7;
    EXPECT_EQ(in.input.pulse(order), TriggerResult::kTaken);
    in.camera.s.trigger_activation = TriggerActivation::kFallingEdge;
    in.input.pulse(order);
    EXPECT_EQ(in.camera.orders.size(), 2u);
    in.camera.s.trigger_activation = TriggerActivation::kAnyEdge;
    in.input.pulse(order);
    EXPECT_EQ(in.camera.orders.size(), 4u);  // the camera misses the second
    in.camera.s.trigger_activation = TriggerActivation::kRisingEdge;
    in.camera.s.trigger_divider = 2;
    EXPECT_EQ(in.input.pulse(order), TriggerResult::kTaken);
    EXPECT_EQ(in.camera.orders.size(), 4u);
    in.input.pulse(order);
    EXPECT_EQ(in.camera.orders.size(), 5u);
    EXPECT_EQ(in.camera.orders[4].sequence, 7u);
    in.camera.s.trigger_divider = 1;
    in.camera.s.exposure_mode = ExposureMode::kTriggerWidth;  // a pulse without length: the shortest exposure
    in.input.pulse(order);
    EXPECT_EQ(in.camera.orders[5].until_monotonic_ns, kMilli_ns);
    ASSERT_EQ(in.exposures.size(), 1u);
    EXPECT_EQ(in.exposures[0].end_ns - in.exposures[0].begin_ns, 10 * kMicrosecond_ns);
    in.camera.s.trigger_source = TriggerSource::kLine3;
    EXPECT_EQ(in.input.pulse(order), TriggerResult::kNotArmed);
}

}  // namespace
}  // namespace hilcam
