// The clock's pieces, by hand; and the hand-over that they go by.

#include "emulator/world/clock.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace hilcam {
namespace {

constexpr std::int64_t kNever_ns = SimulatedClock::kNever_ns;
using Action = ClockCommand::Action;

CommandStatus order(SimulatedClock& clock, Action action, double scale = 1, std::int64_t step_ns = 0) {
    return clock.order({action, 0, scale, step_ns});
}
// What is in a second of the machine's from now on, by what is known now.
std::int64_t in_a_second(const SimulatedClock& clock) {
    const std::int64_t now_ns = monotonic_ns();
    return clock.at(now_ns + kSecond_ns) - clock.at(now_ns);
}
std::int64_t of_camera_in_a_second(const SimulatedClock& clock) {
    const std::int64_t now_ns = monotonic_ns();
    return clock.camera_at(now_ns + kSecond_ns) - clock.camera_at(now_ns);
}

TEST(SimulatedClock, AtScaleOneAllTimesGoTogetherExactly) {
    // A machine that has been on for a month, and a year of simulated time: to the nanosecond.
    constexpr std::int64_t kOn_ns = 30LL * 86'400 * kSecond_ns + 7;
    const TimeTai start{1'800'000'000'123'456'789};
    const SimulatedClock clock(start, kOn_ns);
    constexpr std::int64_t kYear_ns = 365LL * 86'400 * kSecond_ns + 1;
    EXPECT_EQ(clock.at(kOn_ns + kYear_ns) - start, kYear_ns);
    EXPECT_EQ(clock.monotonic_of_camera(clock.camera_at(kOn_ns + kYear_ns)), kOn_ns + kYear_ns);
    EXPECT_EQ(clock.simulated_of_camera(clock.camera_at(kOn_ns + 5)), start + 5);
    EXPECT_EQ(clock.when_due(clock.camera_of(start + 9)), kOn_ns + 9);
}

TEST(SimulatedClock, AScaleStretchesAllOfItAlike) {
    const SimulatedClock slow({100 * kSecond_ns}, 5 * kSecond_ns, false, {.scale = 0.5});
    EXPECT_EQ(slow.at(7 * kSecond_ns).ns, 101 * kSecond_ns);
    EXPECT_EQ(slow.when_due(slow.camera_of({101 * kSecond_ns})), 7 * kSecond_ns);
    const SimulatedClock fast({0}, 0, false, {.scale = 10});
    EXPECT_EQ(fast.at(kSecond_ns).ns, 10 * kSecond_ns);
    // The first nanosecond at which the camera is there.
    EXPECT_EQ(fast.when_due(11), 2);
    EXPECT_EQ(fast.when_due(10), 1);
    for (const double scale : {0.001, 0.1, 0.3, 3.0, 1000.0}) {
        const SimulatedClock clock({0}, 0, false, {.scale = scale});
        for (const std::int64_t camera_ns : {1LL, 999LL, 33'333'333LL, 86'400'000'000'001LL}) {
            const std::int64_t due_ns = clock.when_due(camera_ns);
            EXPECT_GE(clock.camera_at(due_ns), camera_ns) << scale;
            EXPECT_LT(clock.camera_at(due_ns - 1), camera_ns + 1) << scale;
        }
    }
}

TEST(SimulatedClock, WhileTimeStandsTheCameraStreamsOrWaits) {
    const TimeTai start{100 * kSecond_ns};
    const SimulatedClock streams(start, 0, false, {.scale = 2, .paused = true});
    EXPECT_EQ(streams.at(9 * kSecond_ns), start);
    EXPECT_EQ(streams.camera_at(9 * kSecond_ns) - streams.camera_at(0), 18 * kSecond_ns);
    EXPECT_EQ(streams.simulated_of_camera(streams.camera_at(9 * kSecond_ns)), start);
    EXPECT_EQ(streams.camera_of(start + 1), kNever_ns);
    EXPECT_EQ(streams.when_due(kNever_ns), kNever_ns);
    const SimulatedClock waits(start, 0, false,
                               {.scale = 2, .paused = true, .camera_in_pause = CameraInPause::kWaits});
    EXPECT_EQ(waits.at(9 * kSecond_ns), start);
    EXPECT_EQ(waits.camera_at(9 * kSecond_ns), waits.camera_at(0));
    EXPECT_EQ(waits.when_due(waits.camera_at(0)), 0);
    EXPECT_EQ(waits.when_due(waits.camera_at(0) + 1), kNever_ns);
    // An exposure that has begun shows all of its time: it ends when time goes on.
    EXPECT_EQ(waits.simulated_of_camera(waits.camera_at(0) + 50), start + 50);
}

TEST(SimulatedClock, ChangesJoinWithoutAJumpAndLeaveThePastAsItWas) {
    const std::int64_t begun_ns = monotonic_ns();
    SimulatedClock clock({100 * kSecond_ns}, begun_ns);
    const std::int64_t before_ns = monotonic_ns();
    const TimeTai then = clock.at(before_ns);
    ASSERT_EQ(order(clock, Action::kScale, 4), CommandStatus::kAccepted);
    EXPECT_NEAR(static_cast<double>(in_a_second(clock)), 4e9, 1);
    EXPECT_EQ(clock.at(before_ns), then);
    EXPECT_EQ(clock.simulated_of_camera(clock.camera_at(before_ns)), then);
    // Around the change, found by its slope: no step in either.
    std::int64_t low_ns = before_ns, high_ns = monotonic_ns();
    while (high_ns - low_ns > 1) {
        const std::int64_t middle_ns = low_ns + (high_ns - low_ns) / 2;
        const bool at_one = clock.at(middle_ns) - then == middle_ns - before_ns;
        (at_one ? low_ns : high_ns) = middle_ns;
    }
    EXPECT_LE(clock.at(high_ns) - clock.at(low_ns), 4);
    EXPECT_GE(clock.at(high_ns) - clock.at(low_ns), 1);

    ASSERT_EQ(order(clock, Action::kPause), CommandStatus::kAccepted);
    const TimeTai stood = clock.now();
    EXPECT_EQ(in_a_second(clock), 0);
    EXPECT_NEAR(static_cast<double>(of_camera_in_a_second(clock)), 4e9, 1);
    ASSERT_EQ(order(clock, Action::kScale, 100), CommandStatus::kAccepted);  // for when it goes on
    EXPECT_EQ(clock.now(), stood);
    ASSERT_EQ(order(clock, Action::kStep, 1, 30'000'000), CommandStatus::kAccepted);
    ASSERT_EQ(order(clock, Action::kStep, 1, 10'000'000), CommandStatus::kAccepted);
    EXPECT_EQ(clock.at(monotonic_ns() + kSecond_ns), stood + 40'000'000);
    ASSERT_EQ(order(clock, Action::kResume), CommandStatus::kAccepted);
    EXPECT_GE(clock.now(), stood);
    EXPECT_NEAR(static_cast<double>(in_a_second(clock)), 1e11, 1);
    EXPECT_EQ(order(clock, Action::kStep, 1, 1), CommandStatus::kNotNow);
    // The camera's time and the simulated one differ by the pauses alone, in which it streamed at 4 and 100.
    EXPECT_EQ(of_camera_in_a_second(clock), in_a_second(clock));
}

TEST(SimulatedClock, ReadingsSayHowTimeGoesOn) {
    SimulatedClock clock({100 * kSecond_ns}, monotonic_ns(), false, {.scale = 0.25});
    const std::int64_t arrival_ns = monotonic_ns();
    ClockReading r = clock.read(arrival_ns);
    EXPECT_EQ(r.arrival, clock.at(arrival_ns));
    EXPECT_EQ(r.departure, clock.at(r.departure_monotonic_ns));
    EXPECT_GE(r.departure_monotonic_ns, arrival_ns);
    EXPECT_EQ(r.scale, 0.25);
    EXPECT_EQ(r.stands_at.ns, kNever_ns);
    order(clock, Action::kPause);
    r = clock.read(arrival_ns);
    EXPECT_EQ(r.scale, 0.25);
    EXPECT_EQ(r.stands_at, r.departure);
    order(clock, Action::kStep, 1, kSecond_ns);
    EXPECT_EQ(clock.read(arrival_ns).stands_at, r.stands_at + kSecond_ns);
}

TEST(SimulatedClock, StepsToTheEndOfTimeStayThere) {
    SimulatedClock clock({9'000'000'000'000'000'000}, monotonic_ns(), false, {.scale = 1000, .paused = true});
    for (int i = 0; i < 50; ++i)
        EXPECT_EQ(order(clock, Action::kStep, 1, kMaxClockStep_ns), CommandStatus::kAccepted);
    EXPECT_GE(clock.now().ns, 9'000'000'000'000'000'000);
}

TEST(SimulatedClock, LockstepKnowsNoScale) {
    SimulatedClock clock({100}, 0, true, {.scale = 3, .paused = true});
    for (const Action action : {Action::kScale, Action::kPause, Action::kResume, Action::kStep})
        EXPECT_EQ(order(clock, action, 1, 1), CommandStatus::kNotNow);
    EXPECT_EQ(order(clock, Action::kAsk), CommandStatus::kAccepted);
    EXPECT_EQ(clock.now().ns, 100);
    clock.step_to({-50});
    EXPECT_EQ(clock.now().ns, -50);
    EXPECT_EQ(clock.read(7).stands_at.ns, -50);
    // The other axes name instants, before the start as well.
    EXPECT_EQ(clock.simulated_of_camera(-1000).ns, -1000);
    EXPECT_EQ(clock.monotonic_of_camera(100 + 5), 5);
}

// Runs under TSan too.
TEST(SharedLatest, ManyReadersSeeWholeValuesInTheirOrder) {
    struct Value {
        std::int64_t words[9];
    };
    SharedLatest<Value> shared(Value{});
    std::atomic<bool> over{false};
    std::vector<std::thread> readers;
    std::atomic<int> torn{0}, back{0};
    std::atomic<std::int64_t> reads{0};
    for (int i = 0; i < 3; ++i)
        readers.emplace_back([&] {
            std::int64_t newest = 0;
            do {
                const Value v = shared.read();
                for (const std::int64_t word : v.words) torn += word != v.words[0];
                back += v.words[0] < newest;
                newest = v.words[0];
                ++reads;
            } while (!over.load());
        });
    for (std::int64_t n = 1; n <= 200'000; ++n) {
        Value v;
        for (std::int64_t& word : v.words) word = n;
        shared.write(v);
    }
    over = true;
    for (std::thread& reader : readers) reader.join();
    EXPECT_EQ(torn.load(), 0);
    EXPECT_EQ(back.load(), 0);
    EXPECT_GE(reads.load(), 3);
    EXPECT_EQ(shared.read().words[8], 200'000);
}

}  // namespace
}  // namespace hilcam
