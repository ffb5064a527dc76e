// Triggers from lines, lines, counters and timers as a client sets them.

#include <gmock/gmock.h>

#include "gige_bench.h"
#include "io/gige/device/gige_features.h"
#include "io/gige/device/gige_lines.h"
#include "io/gige/device/gige_messages.h"

namespace hilcam {
namespace {

namespace reg = feature_register;

// Line0 and Line2 are inputs, Line1 and Line3 outputs; Line2 and Line3 have pins.
LinePlan wiring() {
    LinePlan plan;
    plan.is_there = {true, true, true, true};
    plan.is_output = {false, true, false, true};
    plan.has_pin = {false, false, true, true};
    plan.source[1] = LineSignal::kExposureActive;
    return plan;
}
constexpr std::uint32_t own(std::uint32_t line) { return GigeLines::kFirstOwn + line; }

struct LineClient : GigeBench {
    LineClient() : GigeBench(nullptr, {"Trigger"}, ClockSource::kTai, false, wiring()) { take_control(); }
    void edge(std::uint8_t line, bool level, std::int64_t at_ns) {
        lines.edge({line, level, at_ns, 0}, at_ns);
    }
};

TEST(GigeLines, TheTriggersEdgeDividerAndOverlapAreTheCameras) {
    LineClient b;
    EXPECT_EQ(b.read(reg::kTriggerDivider), 1u);
    EXPECT_EQ(b.read(reg::kTriggerOverlap), 1u);  // ReadOut
    EXPECT_EQ(b.write(reg::kTriggerActivation, 2), gvcp::kSuccess);
    EXPECT_EQ(b.camera.s.trigger_activation, TriggerActivation::kAnyEdge);
    EXPECT_EQ(b.write(reg::kTriggerActivation, 4), gvcp::kSuccess);
    EXPECT_EQ(b.camera.s.trigger_activation, TriggerActivation::kLevelLow);
    EXPECT_EQ(b.write(reg::kTriggerActivation, 5), gvcp::kInvalidParameter);
    EXPECT_EQ(b.write(reg::kTriggerDivider, 5), gvcp::kSuccess);
    EXPECT_EQ(b.camera.s.trigger_divider, 5);
    EXPECT_EQ(b.write(reg::kTriggerDivider, 0), gvcp::kInvalidParameter);
    EXPECT_EQ(b.write(reg::kTriggerOverlap, 0), gvcp::kSuccess);
    EXPECT_EQ(b.camera.s.trigger_overlap, TriggerOverlap::kOff);
    EXPECT_EQ(b.write(reg::kTriggerOverlap, 2), gvcp::kInvalidParameter);
    EXPECT_EQ(b.write(reg::kExposureMode, 2), gvcp::kSuccess);
    EXPECT_EQ(b.camera.s.exposure_mode, ExposureMode::kTriggerWidth);
    EXPECT_EQ(b.write(reg::kExposureMode, 0), gvcp::kInvalidParameter);
    EXPECT_EQ(b.write(reg::kExposureMode, 1), gvcp::kSuccess);
    EXPECT_EQ(b.camera.s.exposure_mode, ExposureMode::kTimed);
}

TEST(GigeLines, ATriggerComesFromAnyInputAndFromNoOutput) {
    LineClient b;
    EXPECT_EQ(b.write(reg::kTriggerSource, own(2)), gvcp::kSuccess);
    EXPECT_EQ(b.camera.s.trigger_source, TriggerSource::kLine2);
    EXPECT_EQ(b.read(reg::kTriggerSource), own(2));
    for (const std::uint32_t none : {own(0), own(1), own(4), own(8), 4u})
        EXPECT_EQ(b.write(reg::kTriggerSource, none), gvcp::kInvalidParameter) << none;
    b.write(reg::kTriggerMode, 1);
    b.edge(2, true, 5'000);
    ASSERT_EQ(b.camera.triggers.size(), 1u);
    EXPECT_EQ(b.camera.triggers[0].source, TriggerSource::kLine2);
    EXPECT_EQ(b.camera.triggers[0].at_monotonic_ns, 5'000);
    EXPECT_EQ(b.write(reg::kTriggerSource, 3), gvcp::kSuccess);  // Line0 by its other name
    EXPECT_EQ(b.camera.s.trigger_source, TriggerSource::kLine0);
}

TEST(GigeLines, ALineSaysWhatItIs) {
    LineClient b;
    const struct {
        std::uint32_t line, mode, format, source;
    } cases[] = {{0, 0, 0, 0}, {1, 0, 0, 0}, {own(1), 1, 0, 1}, {own(2), 0, 1, 0}, {own(3), 1, 1, 0}};
    for (const auto& c : cases) {
        ASSERT_EQ(b.write(reg::kLineSelector, c.line), gvcp::kSuccess);
        EXPECT_EQ(b.read(reg::kLineMode), c.mode);
        EXPECT_EQ(b.write(reg::kLineMode, c.mode), gvcp::kSuccess);
        EXPECT_EQ(b.write(reg::kLineMode, 1 - c.mode), gvcp::kInvalidParameter);
        EXPECT_EQ(b.read(reg::kLineFormat), c.format);
        EXPECT_EQ(b.read(reg::kLineSource), c.source);
        EXPECT_EQ(b.write(reg::kLineSource, 2), c.mode ? gvcp::kSuccess : gvcp::kAccessDenied);
    }
    EXPECT_EQ(b.write(reg::kLineSource, 12), gvcp::kInvalidParameter);
    for (const std::uint32_t none : {2u, own(0), own(4), own(8)})
        EXPECT_EQ(b.write(reg::kLineSelector, none), gvcp::kInvalidParameter) << none;
}

TEST(GigeLines, LevelsAreTrue) {
    LineClient b;
    b.edge(2, true, 10);
    EXPECT_EQ(b.read(reg::kLineStatusAll), 0b0100u);
    b.write(reg::kLineSelector, own(2));
    EXPECT_EQ(b.read(reg::kLineStatus), 1u);
    b.write(reg::kLineInverter, 1);
    EXPECT_EQ(b.read(reg::kLineStatus), 0u);
    b.write(reg::kLineSelector, own(3));
    EXPECT_EQ(b.read(reg::kLineInverter), 0u);
    b.write(reg::kLineSource, static_cast<std::uint32_t>(LineSignal::kUserOutput1));
    b.write(reg::kUserOutputSelector, 1);
    EXPECT_EQ(b.write(reg::kUserOutputValue, 1), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kUserOutputValueAll), 0b10u);
    EXPECT_EQ(b.read(reg::kLineStatus), 1u);
    EXPECT_EQ(b.write(reg::kUserOutputValueAll, 0), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kLineStatus), 0u);
    EXPECT_EQ(b.write(reg::kUserOutputValueAll, 16), gvcp::kInvalidParameter);
}

TEST(GigeLines, ACounterCountsForTheClient) {
    LineClient b;
    b.write(reg::kCounterSelector, 1);
    EXPECT_EQ(b.read(reg::kCounterStatus), 0u);  // CounterIdle
    EXPECT_EQ(b.write(reg::kCounterEventSource, static_cast<std::uint32_t>(event_of_line(2))),
              gvcp::kSuccess);
    EXPECT_EQ(b.write(reg::kCounterEventActivation, 1), gvcp::kSuccess);  // FallingEdge
    EXPECT_EQ(b.write(reg::kCounterDuration, 2), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kCounterStatus), 2u);  // CounterActive
    for (int i = 0; i < 6; ++i) b.edge(2, i % 2 == 0, 10 * i);
    EXPECT_EQ(b.read(reg::kCounterValue), 2u);
    EXPECT_EQ(b.read(reg::kCounterStatus), 3u);  // CounterCompleted
    EXPECT_EQ(b.write(reg::kCounterReset, 1), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kCounterValue), 0u);
    EXPECT_EQ(b.read(reg::kCounterValueAtReset), 2u);
    EXPECT_EQ(b.write(reg::kCounterValue, 1), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kCounterValue), 1u);
    EXPECT_EQ(b.write(reg::kCounterDuration, 0), gvcp::kInvalidParameter);
    for (const std::size_t none : {1u, 3u, 5u})  // outputs, and no line
        EXPECT_EQ(b.write(reg::kCounterEventSource, static_cast<std::uint32_t>(event_of_line(none))),
                  gvcp::kInvalidParameter);
    b.write(reg::kCounterSelector, 0);
    EXPECT_EQ(b.read(reg::kCounterEventSource), 0u);
    EXPECT_EQ(b.write(reg::kCounterSelector, 2), gvcp::kInvalidParameter);
}

TEST(GigeLines, ATimerRunsForTheClient) {
    LineClient b;
    b.write(reg::kTimerSelector, 1);
    EXPECT_EQ(b.write_real(reg::kTimerDelay_us, 500), gvcp::kSuccess);
    EXPECT_EQ(b.write_real(reg::kTimerDuration_us, 2000), gvcp::kSuccess);
    EXPECT_EQ(b.write_real(reg::kTimerDuration_us, 0.5), gvcp::kInvalidParameter);
    EXPECT_EQ(b.write_real(reg::kTimerDelay_us, std::nan("")), gvcp::kInvalidParameter);
    EXPECT_EQ(b.read(reg::kTimerStatus), 0u);  // TimerIdle
    EXPECT_EQ(b.write(reg::kTimerTriggerSource, static_cast<std::uint32_t>(LineEvent::kExposureStart)),
              gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kTimerStatus), 1u);  // TimerTriggerWait
    b.write(reg::kLineSelector, own(3));
    b.write(reg::kLineSource, static_cast<std::uint32_t>(LineSignal::kTimer1Active));
    EXPECT_EQ(b.write(reg::kTimerReset, 1), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kTimerStatus), 2u);  // TimerActive
    b.now_ns += 1'000'000;
    b.lines.tick(b.now_ns);
    EXPECT_EQ(b.read(reg::kLineStatus), 1u);
    EXPECT_DOUBLE_EQ(b.read_real(reg::kTimerValue_us), 500);
    b.now_ns += 2'000'000;
    b.lines.tick(b.now_ns);
    EXPECT_EQ(b.read(reg::kLineStatus), 0u);
    EXPECT_EQ(b.read(reg::kTimerStatus), 1u);
}

TEST(GigeLines, UserSetsKeepThem) {
    LineClient b;
    b.write(reg::kTriggerDivider, 3);
    b.write(reg::kLineSelector, own(3));
    b.write(reg::kLineSource, static_cast<std::uint32_t>(LineSignal::kFrameActive));
    b.write(reg::kLineInverter, 1);
    b.write(reg::kCounterDuration, 9);
    b.write(reg::kUserSetSelector, 1);
    EXPECT_EQ(b.write(reg::kUserSetSave, 1), gvcp::kSuccess);
    b.write(reg::kUserSetSelector, 0);
    EXPECT_EQ(b.write(reg::kUserSetLoad, 1), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kLineSource), 0u);
    EXPECT_EQ(b.read(reg::kLineInverter), 0u);
    EXPECT_EQ(b.read(reg::kTriggerDivider), 1u);
    EXPECT_EQ(b.read(reg::kCounterDuration), 0xFFFFFFFFu);
    b.write(reg::kUserSetSelector, 1);
    EXPECT_EQ(b.write(reg::kUserSetLoad, 1), gvcp::kSuccess);
    EXPECT_EQ(b.read(reg::kLineSource), static_cast<std::uint32_t>(LineSignal::kFrameActive));
    EXPECT_EQ(b.read(reg::kLineInverter), 1u);
    EXPECT_EQ(b.read(reg::kTriggerDivider), 3u);
    EXPECT_EQ(b.read(reg::kCounterDuration), 9u);
}

TEST(GigeLines, EdgesOfLine0AreEvents) {
    LineClient b;
    b.write(bootstrap::kMessageAddress, kClient.ip);
    b.write(bootstrap::kMessagePort, 60000);
    const auto place = [](const char* name) {
        for (std::uint32_t i = 0; i < kGigeEvents.size(); ++i)
            if (std::string(kGigeEvents[i].name) == name) return i;
        return 99u;
    };
    b.write(reg::kEventSelector, place("Line0RisingEdge"));
    b.write(reg::kEventNotification, 1);
    b.device.on_event({CameraEvent::Kind::kLine0Rises, 0, 7'000}, 0, b.now_ns);
    b.device.on_event({CameraEvent::Kind::kLine0Falls, 0, 8'000}, 0, b.now_ns);
    ASSERT_EQ(b.messages.size(), 1u);
    // GVCP header, then length or reserved, event id, channel, block, time stamp.
    ByteReader in(std::span(b.messages[0].bytes).subspan(8));
    in.u16();
    EXPECT_EQ(in.u16(), kGigeEvents[place("Line0RisingEdge")].id);
    in.skip(4);
    EXPECT_EQ(in.u64(), 7'000u);
}

TEST(GigeLines, TheDescriptionHasTheLinesThatAreThere) {
    LineClient b;
    const FeatureTable table = gige_features(b.camera.l, false, {"Trigger"}, wiring());
    const auto entries = [&](const char* name) {
        std::vector<std::string> out;
        for (const Feature& f : table.features)
            if (f.name == name)
                for (const EnumEntry& entry : f.entries) out.push_back(entry.name);
        return out;
    };
    using testing::ElementsAre;
    EXPECT_THAT(entries("LineSelector"), ElementsAre("Line0", "Trigger", "Line1", "Line2", "Line3"));
    EXPECT_THAT(entries("TriggerSource"), ElementsAre("Software", "Line0", "Action1", "Trigger", "Line2"));
    EXPECT_THAT(entries("TriggerActivation"),
                ElementsAre("RisingEdge", "FallingEdge", "AnyEdge", "LevelHigh", "LevelLow"));
    EXPECT_THAT(entries("CounterEventActivation"), ElementsAre("RisingEdge", "FallingEdge", "AnyEdge"));
    const auto events = entries("CounterEventSource");
    EXPECT_THAT(events, testing::Contains("Line2"));
    EXPECT_THAT(events, testing::Not(testing::Contains("Line1")));
    EXPECT_EQ(entries("TimerTriggerSource"), events);
    for (const Feature& f : table.features)
        if (f.name == "ExposureMode") {
            EXPECT_EQ(f.access, Feature::Access::kReadWrite);
        }
}

TEST(GigeLines, ACameraThatSetsItsOwnExposureHasNoWidth) {
    CameraLimits limits = PlainCamera().l;
    limits.exposure_is_own = limits.frame_rate_is_own = true;
    for (const Feature& f : gige_features(limits, false).features)
        if (f.name == "ExposureMode" || f.name == "TriggerOverlap") {
            EXPECT_EQ(f.entries.size(), 1u);
            EXPECT_EQ(f.access, Feature::Access::kRead);
        }
}

}  // namespace
}  // namespace hilcam
