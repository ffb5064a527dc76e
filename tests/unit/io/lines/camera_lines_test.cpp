#include "io/lines/camera_lines.h"

#include <gtest/gtest.h>

#include "wired_camera.h"

namespace hilcam {
namespace {

// Line0 and Line2 are inputs, Line1 and Line3 outputs.
LinePlan plan() {
    LinePlan plan;
    plan.is_there = {true, true, true, true};
    plan.is_output = {false, true, false, true};
    return plan;
}

struct Wires {
    WiredCamera camera;
    CameraLines lines;

    explicit Wires(const LinePlan& with = plan()) : lines(camera, with) {}
    template <class Change>
    void set(const Change& change, std::int64_t at_us = 0) {
        LineSettings settings = lines.settings();
        change(settings);
        lines.change(settings, at_us * kMicrosecond_ns);
    }
    bool edge(std::uint8_t line, bool level, std::int64_t at_us, std::int64_t now_us = -1) {
        return lines.edge({line, level, at_us * kMicrosecond_ns, 0},
                          (now_us < 0 ? at_us : now_us) * kMicrosecond_ns);
    }
    void exposure(std::int64_t begin_us, std::int64_t end_us) {
        lines.post({LineEvent::kExposureStart, begin_us * kMicrosecond_ns, end_us * kMicrosecond_ns});
    }
    void tick(std::int64_t at_us) { lines.tick(at_us * kMicrosecond_ns); }
    // Returns the outputs' new edges as (line, level, time in us).
    std::vector<std::array<std::int64_t, 3>> out() {
        std::vector<std::array<std::int64_t, 3>> edges;
        for (LineEdge e; lines.take_output(e);)
            edges.push_back({e.line, e.level ? 1 : 0, e.monotonic_ns / kMicrosecond_ns});
        return edges;
    }
};
using Edges = std::vector<std::array<std::int64_t, 3>>;

TEST(CameraLines, AnEdgeToTheLevelThatTheWireHasIsNone) {
    Wires w;
    EXPECT_TRUE(w.edge(0, true, 10));
    EXPECT_TRUE(w.edge(0, true, 20));
    EXPECT_TRUE(w.edge(0, false, 30));
    EXPECT_EQ(w.camera.orders.size(), 1u);
    EXPECT_FALSE(w.edge(1, true, 40));  // an output
    EXPECT_FALSE(w.edge(5, true, 40));  // no such line
    EXPECT_FALSE(w.edge(200, true, 40));
}

// Edges with times to come: the level from 200 to 2200 us, at 1000 frames a second.
TEST(CameraLines, FramesOfALevelBeginAtTheirInstantsHoweverLateTheTickIs) {
    Wires w;
    w.camera.s.trigger_activation = TriggerActivation::kLevelHigh;
    w.camera.s.frame_rate_hz = 1000;
    w.edge(0, true, 200, 100);
    w.edge(0, false, 2200, 100);
    w.tick(5000);
    ASSERT_EQ(w.camera.orders.size(), 2u);
    EXPECT_EQ(w.camera.orders[0].at_monotonic_ns, 200 * kMicrosecond_ns);
    EXPECT_EQ(w.camera.orders[1].at_monotonic_ns, 1200 * kMicrosecond_ns);
    // From then on settings may begin a level without an edge.
    EXPECT_EQ(w.lines.wake_ns(), 10'000 * kMicrosecond_ns);
}

TEST(CameraLines, AnEdgeToComeCountsAtItsTime) {
    Wires w;
    EXPECT_TRUE(w.edge(0, false, 300, 100));
    EXPECT_TRUE(w.edge(0, true, 200, 100));  // arrives later and is earlier
    EXPECT_EQ(w.lines.wake_ns(), 200 * kMicrosecond_ns);
    w.tick(199);
    EXPECT_EQ(w.lines.levels(), 0u);
    w.tick(250);
    EXPECT_EQ(w.lines.levels(), 1u);
    ASSERT_EQ(w.camera.orders.size(), 1u);
    EXPECT_EQ(w.camera.orders[0].at_monotonic_ns, 200 * kMicrosecond_ns);
    w.tick(300);
    EXPECT_EQ(w.lines.levels(), 0u);
    for (int i = 0; i < 64; ++i) EXPECT_TRUE(w.edge(0, i % 2 == 0, 1000 + i, 500));
    EXPECT_FALSE(w.edge(0, true, 2000, 500));
}

TEST(CameraLines, AnInvertedInputIsActiveWhenItsWireIsLow) {
    Wires w;
    EXPECT_EQ(w.lines.levels(), 0u);
    w.set([](LineSettings& s) { s.inverted[0] = true; });
    EXPECT_EQ(w.lines.levels(), 1u);
    w.edge(0, true, 10);
    EXPECT_EQ(w.lines.levels(), 0u);
    EXPECT_TRUE(w.camera.orders.empty());
    w.edge(0, false, 20);
    ASSERT_EQ(w.camera.orders.size(), 1u);
    EXPECT_EQ(w.camera.orders[0].at_monotonic_ns, 20 * kMicrosecond_ns);
}

TEST(CameraLines, AnOutputShowsTheExposureFromItsBeginToItsEnd) {
    Wires w;
    w.exposure(50, 60);  // nobody listens yet
    w.set([](LineSettings& s) {
        s.source[1] = LineSignal::kExposureActive;
        s.source[3] = LineSignal::kFrameActive;
        s.inverted[3] = true;
    });
    EXPECT_EQ(w.out(), (Edges{{3, 1, 0}}));  // inverted: high at rest
    w.exposure(100, 400);
    w.tick(130);
    EXPECT_EQ(w.out(), (Edges{{1, 1, 100}, {3, 0, 100}}));
    EXPECT_EQ(w.lines.levels(), 0b0010u);
    EXPECT_EQ(w.lines.wake_ns(), 400 * kMicrosecond_ns);
    w.tick(405);
    EXPECT_EQ(w.out(), (Edges{{1, 0, 400}}));
    w.lines.post({LineEvent::kFrameEnd, 900 * kMicrosecond_ns, 0});
    w.tick(910);
    EXPECT_EQ(w.out(), (Edges{{3, 1, 900}}));
    EXPECT_EQ(w.lines.lost(), 0u);
}

// A late tick shows every edge, in order.
TEST(CameraLines, ExposuresOneAfterTheOtherAreTwoPulses) {
    Wires w;
    w.set([](LineSettings& s) { s.source[1] = LineSignal::kExposureActive; });
    w.exposure(100, 200);
    w.exposure(200, 300);
    w.exposure(350, 380);
    w.tick(500);
    EXPECT_EQ(w.out(), (Edges{{1, 1, 100}, {1, 0, 200}, {1, 1, 200}, {1, 0, 300}, {1, 1, 350}, {1, 0, 380}}));
}

// The loop gets to a frame later than its trigger, and knows its settings.
TEST(CameraLines, AnExposureThatATriggerTellsIsShownBeforeTheLoopHasIt) {
    Wires w;
    w.set([](LineSettings& s) { s.source[1] = LineSignal::kExposureActive; });
    const auto told = [&](std::int64_t begin_us, std::int64_t end_us) { w.exposure(begin_us, end_us); };
    told(500, 600);
    told(200, 300);
    w.tick(100);
    EXPECT_EQ(w.out(), Edges{});
    EXPECT_EQ(w.lines.wake_ns(), 200 * kMicrosecond_ns);
    w.tick(210);
    EXPECT_EQ(w.out(), (Edges{{1, 1, 200}}));
    w.exposure(200, 320);  // the loop, with the exposure that has been set meanwhile
    w.tick(400);
    EXPECT_EQ(w.out(), (Edges{{1, 0, 320}}));
    w.tick(610);
    EXPECT_EQ(w.out(), (Edges{{1, 1, 500}, {1, 0, 600}}));
    w.exposure(500, 600);  // far too late: has been shown
    w.tick(700);
    EXPECT_EQ(w.out(), Edges{});
    told(900, 950);
    w.tick(800);
    w.lines.drop_exposures();
    w.tick(1000);
    EXPECT_EQ(w.out(), Edges{});
    w.exposure(1100, 1150);  // of another frame
    w.tick(1200);
    EXPECT_EQ(w.out(), (Edges{{1, 1, 1100}, {1, 0, 1150}}));
}

// The loop may be quicker than the thread that takes the trigger and tells of its exposure.
TEST(CameraLines, AnExposureThatIsPostedTwiceIsOneFrame) {
    Wires w;
    w.set([](LineSettings& s) { s.counters[0].event = LineEvent::kFrameStart; });
    w.exposure(200, 320);  // the loop's
    w.tick(250);
    w.exposure(200, 300);  // the trigger's
    w.exposure(500, 600);
    w.exposure(500, 600);
    w.tick(1000);
    EXPECT_EQ(w.lines.counter(0).value(), 2u);
}

TEST(CameraLines, ARollingShuttersExposuresThatOverlapAreOnePulse) {
    Wires w;
    w.set([](LineSettings& s) { s.source[1] = LineSignal::kExposureActive; });
    w.exposure(100, 300);
    w.tick(110);
    w.exposure(250, 450);
    w.tick(260);
    w.tick(500);
    EXPECT_EQ(w.out(), (Edges{{1, 1, 100}, {1, 0, 450}}));
}

TEST(CameraLines, AnExposureByWidthIsShownAtItsEdgesAndNotAgainWhenItsFrameBegins) {
    Wires w;
    w.camera.s.exposure_mode = ExposureMode::kTriggerWidth;
    w.set([](LineSettings& s) { s.source[1] = LineSignal::kExposureActive; });
    w.edge(0, true, 100);
    EXPECT_EQ(w.out(), (Edges{{1, 1, 100}}));
    w.edge(0, false, 900);
    w.tick(900);
    EXPECT_EQ(w.out(), (Edges{{1, 0, 900}}));
    w.exposure(100, 900);
    w.tick(950);
    EXPECT_EQ(w.out(), Edges{});
}

TEST(CameraLines, TheReadyLineFollowsTheCamera) {
    Wires w;
    w.set([](LineSettings& s) { s.source[1] = LineSignal::kFrameTriggerWait; });
    EXPECT_EQ(w.out(), (Edges{{1, 1, 0}}));
    w.camera.ready_ns = 5000 * kMicrosecond_ns;
    w.tick(1000);
    EXPECT_EQ(w.out(), (Edges{{1, 0, 1000}}));
    EXPECT_LE(w.lines.wake_ns(), 6000 * kMicrosecond_ns);
    w.tick(6000);
    EXPECT_EQ(w.out(), (Edges{{1, 1, 6000}}));
    w.camera.s.triggered = false;
    w.tick(7000);
    EXPECT_EQ(w.out(), (Edges{{1, 0, 7000}}));
}

TEST(CameraLines, UserOutputsAreLevelsOfTheClient) {
    Wires w;
    w.set([](LineSettings& s) { s.source[3] = LineSignal::kUserOutput2, s.user_outputs = 0b011; });
    EXPECT_EQ(w.out(), Edges{});
    w.set([](LineSettings& s) { s.user_outputs = 0b100; }, 5);
    EXPECT_EQ(w.out(), (Edges{{3, 1, 5}}));
    EXPECT_EQ(w.lines.levels(), 0b1000u);
}

TEST(CameraLines, ACounterCountsUntilItsEndAndBeginsAgainAtItsReset) {
    Wires w;
    w.set([](LineSettings& s) {
        s.counters[0] = {.event = LineEvent::kExposureStart, .reset = event_of_line(2), .duration = 3};
        s.source[1] = LineSignal::kCounter0Active;
    });
    const auto status = [&] { return w.lines.counter(0).status(w.lines.settings().counters[0]); };
    EXPECT_EQ(w.out(), (Edges{{1, 1, 0}}));
    for (int i = 1; i <= 5; ++i) w.exposure(100 * i, 100 * i + 10);
    w.tick(1000);
    EXPECT_EQ(w.lines.counter(0).value(), 3u);
    EXPECT_EQ(status(), LineCounter::Status::kCompleted);
    EXPECT_EQ(w.out(), (Edges{{1, 0, 300}}));
    w.edge(2, true, 1100);
    EXPECT_EQ(w.lines.counter(0).value(), 0u);
    EXPECT_EQ(w.lines.counter(0).value_at_reset(), 3u);
    EXPECT_EQ(status(), LineCounter::Status::kActive);
    w.edge(2, false, 1150);  // a falling edge resets nothing
    w.exposure(1200, 1210);
    w.tick(1300);
    EXPECT_EQ(w.lines.counter(0).value(), 1u);
    w.lines.reset_counter(0, 1400 * kMicrosecond_ns);
    EXPECT_EQ(w.lines.counter(0).value(), 0u);
    w.set([](LineSettings& s) { s.counters[0].event = LineEvent::kOff; });
    EXPECT_EQ(status(), LineCounter::Status::kIdle);
}

TEST(CameraLines, ACounterOfEdgesAndOneOfItsEndsDivide) {
    Wires w;
    w.set([](LineSettings& s) {
        s.counters[0] = {.event = event_of_line(2),
                         .activation = TriggerActivation::kAnyEdge,
                         .reset = LineEvent::kCounter0End,
                         .duration = 4};
        s.counters[1] = {.event = LineEvent::kCounter0End};
    });
    for (int i = 0; i < 10; ++i) w.edge(2, i % 2 == 0, 10 * i);
    EXPECT_EQ(w.lines.counter(1).value(), 2u);
    EXPECT_EQ(w.lines.counter(0).value(), 2u);
}

TEST(CameraLines, TriggersAndMissedOnesAreCounted) {
    Wires w;
    w.set([](LineSettings& s) {
        s.counters[0].event = LineEvent::kFrameTrigger;
        s.counters[1].event = LineEvent::kFrameTriggerMissed;
    });
    for (int i = 0; i < 3; ++i) w.lines.post({LineEvent::kFrameTrigger, i, 0});
    w.lines.post({LineEvent::kFrameTriggerMissed, 5, 0});
    w.tick(1);
    EXPECT_EQ(w.lines.counter(0).value(), 3u);
    EXPECT_EQ(w.lines.counter(1).value(), 1u);
}

TEST(CameraLines, ATimerIsAPulseAfterItsDelay) {
    Wires w;
    w.set([](LineSettings& s) {
        s.timers[0] = {.trigger = LineEvent::kExposureStart, .delay_us = 50, .duration_us = 200};
        s.timers[1] = {.trigger = LineEvent::kTimer0End, .duration_us = 10};
        s.source[1] = LineSignal::kTimer0Active;
        s.source[3] = LineSignal::kTimer1Active;
    });
    const auto status = [&] { return w.lines.timer(0).status(w.lines.settings().timers[0]); };
    EXPECT_EQ(status(), LineTimer::Status::kTriggerWait);
    w.exposure(1000, 1100);
    w.tick(1010);
    EXPECT_EQ(w.out(), Edges{});
    EXPECT_EQ(status(), LineTimer::Status::kActive);
    EXPECT_EQ(w.lines.wake_ns(), 1050 * kMicrosecond_ns);
    w.exposure(1110, 1120);  // while it runs: does not count
    w.tick(1120);
    EXPECT_DOUBLE_EQ(w.lines.timer(0).value_us(1120 * kMicrosecond_ns), 70);
    w.tick(2000);
    EXPECT_EQ(w.out(), (Edges{{1, 1, 1050}, {1, 0, 1250}, {3, 1, 1250}, {3, 0, 1260}}));
    w.lines.start_timer(0, 3000 * kMicrosecond_ns);
    w.tick(4000);
    EXPECT_EQ(w.out().size(), 4u);
}

TEST(CameraLines, APulseOfTheCommandExposeIsAnEdgeForCounters) {
    Wires w;
    std::vector<LineEdge> told;
    w.lines.on_edge([&](const LineEdge& edge) { told.push_back(edge); });
    w.set([](LineSettings& s) { s.counters[0].event = event_of_line(0); });
    TriggerOrder order;
    order.source = TriggerSource::kLine0, order.at_monotonic_ns = kMilli_ns;
    EXPECT_EQ(w.lines.pulse(order), TriggerResult::kTaken);
    EXPECT_EQ(w.camera.orders.size(), 1u);
    EXPECT_EQ(w.lines.counter(0).value(), 1u);
    ASSERT_EQ(told.size(), 2u);
    EXPECT_TRUE(told[0].level && !told[1].level);
    EXPECT_EQ(w.lines.levels(), 0u);
}

TEST(CameraLines, WhatIsPostedWakesOnlyWhereItMatters) {
    Wires w;
    int woken = 0;
    w.lines.on_wake([&] { ++woken; });
    w.exposure(10, 20);
    EXPECT_EQ(woken, 0);
    w.set([](LineSettings& s) { s.timers[0].trigger = LineEvent::kFrameEnd; });
    woken = 0;
    w.exposure(10, 20);
    EXPECT_EQ(woken, 1);
    for (int i = 0; i < 300; ++i) w.exposure(i, i + 1);
    EXPECT_EQ(w.lines.lost(), 301u - 256u);
}

}  // namespace
}  // namespace hilcam
