#include "io/ptp/device_clock.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "io/ptp/device_clock_config.h"
#include "io/ptp/oscillator.h"

namespace hilcam {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

TEST(ClockLine, GainsWhatItsRateSays) {
    const ClockLine line{5 * kSecond, 1 * kSecond, 100e-6};
    EXPECT_EQ(line.device_at(5 * kSecond), 1 * kSecond);
    EXPECT_EQ(line.device_at(15 * kSecond), 11'001'000'000);
    EXPECT_EQ(line.device_at(0), 1 * kSecond - 5'000'500'000);
}

TEST(ClockLine, TheInverseIsExactToANanosecond) {
    for (const double rate : {0.0, 100e-6, -500e-6}) {
        const ClockLine line{3 * kSecond + 7, 1'700'000'000 * kSecond + 13, rate};
        for (std::int64_t t = -20 * kSecond; t < 86'400 * kSecond; t += 777 * kSecond + 123'457)
            EXPECT_NEAR(static_cast<double>(line.monotonic_at(line.device_at(t)) - t), 0, 1) << rate << t;
    }
}

TEST(ClockLine, TimesOutOfRangeAreTheNearestOnes) {
    constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
    EXPECT_EQ(ClockLine({100 * kSecond, -100 * kSecond, 0}).monotonic_at(kMost), kMost);
    EXPECT_EQ(ClockLine({0, kMost - 5, 0}).device_at(10), kMost);
    EXPECT_EQ(ClockLine({0, -kMost, 0}).device_at(-10), std::numeric_limits<std::int64_t>::min());
}

TEST(DeviceClock, IsTheMachinesMonotonicClockUnlessToldOtherwise) {
    const DeviceClock clock;
    EXPECT_EQ(clock.device_ns(123'456'789), 123'456'789);
    EXPECT_EQ(clock.monotonic_ns(123'456'789), 123'456'789);
}

TEST(DeviceClock, StepsAndChangesOfRateContinueTheLine) {
    DeviceClock clock({.rate = 50e-6}, {10 * kSecond, 0, 0});
    EXPECT_EQ(clock.device_ns(20 * kSecond), 10 * kSecond + 500'000);
    clock.steer(20 * kSecond, -50e-6);
    EXPECT_EQ(clock.device_ns(20 * kSecond), 10 * kSecond + 500'000);
    // (1 + 50e-6) (1 - 50e-6) - 1 = -2.5e-9
    EXPECT_EQ(clock.device_ns(30 * kSecond), 20 * kSecond + 500'000 - 25);
    clock.step(30 * kSecond, -500'000);
    EXPECT_EQ(clock.device_ns(30 * kSecond), 20 * kSecond - 25);
    clock.set(30 * kSecond, 0);
    EXPECT_EQ(clock.device_ns(31 * kSecond), kSecond - 2);
}

TEST(DeviceClock, TheCorrectionOfTheRateIsLimited) {
    DeviceClock clock;
    clock.steer(0, 0.5);
    EXPECT_EQ(clock.device_ns(kSecond), kSecond + 1'000'000);
}

// The variance of a walk of n steps is n times that of one. Over 400 walks of 100 steps, the mean of the
// squares has a standard deviation of sqrt(2 / 400) = 7 %; three of them are accepted.
TEST(Oscillator, WalksAsFarAsTheConfigurationSays) {
    double sum = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        Oscillator oscillator({.rate = 20e-6, .wander = 0.01e-6, .seed = seed});
        EXPECT_NEAR(oscillator.rate_in(0), 20e-6, 0);
        const double walked = oscillator.rate_in(100) - 20e-6;
        sum += walked * walked;
    }
    EXPECT_NEAR(std::sqrt(sum / 400 / 100), 0.01e-6, 0.1 * 0.01e-6);
}

TEST(Oscillator, IsAFunctionOfSeedAndSecond) {
    Oscillator at_once({.wander = 0.1e-6, .seed = 3}), by_second({.wander = 0.1e-6, .seed = 3}),
        other({.wander = 0.1e-6, .seed = 4});
    double last = 0;
    for (int second = 0; second <= 1000; ++second) last = by_second.rate_in(second);
    EXPECT_EQ(at_once.rate_in(1000), last);
    EXPECT_NE(other.rate_in(1000), last);
}

TEST(DeviceClock, WandersWithItsOscillator) {
    DeviceClock clock({.wander = 0.1e-6, .seed = 3}, {0, 0, 0});
    for (std::int64_t t = 0; t <= 1000; ++t) clock.advance(t * kSecond);
    EXPECT_NEAR(clock.line().rate, Oscillator({.wander = 0.1e-6, .seed = 3}).rate_in(1000), 1e-15);
    EXPECT_NE(clock.device_ns(1000 * kSecond), 1000 * kSecond);
}

// A reader that mixes two lines would find a time far from both.
TEST(DeviceClock, AReaderSeesWholeLinesWhileTheyChange) {
    DeviceClock clock;
    std::atomic<bool> stop{false};
    std::atomic<int> wrong{0};
    std::thread reader([&] {
        while (!stop.load()) {
            const ClockLine line = clock.line();
            // Each line is written with its reading 1000 s times a whole number, at that number of seconds.
            if (line.device_ns != line.monotonic_ns * 1000) wrong.fetch_add(1);
        }
    });
    for (std::int64_t i = 1; i < 200'000; ++i) clock.set(i * kSecond, i * kSecond * 1000);
    stop.store(true);
    reader.join();
    EXPECT_EQ(wrong.load(), 0);
}

TEST(DeviceClockConfig, StartsAtZeroOrAtTheMachinesTime) {
    DeviceClockConfig c;
    c.offset_s = 1.5;
    EXPECT_EQ(start_ns(c, 7'000), 1'500'000'000);
    c.start = ClockStart::kMachine;
    EXPECT_EQ(start_ns(c, 7'000), 1'500'007'000);
}

TEST(DeviceClockConfig, TwoCamerasWithOneSeedWanderApart) {
    DeviceClockConfig c;
    EXPECT_NE(oscillator_of(c, 1).seed, oscillator_of(c, 2).seed);
    EXPECT_EQ(oscillator_of(c, 1).seed, oscillator_of(c, 1).seed);
}

TEST(DeviceClockConfig, RefusesWhatContradictsItself) {
    DeviceClockConfig c;
    EXPECT_NO_THROW(validate(c));
    c.source = ClockSource::kFree;
    c.enable_ptp = true;
    EXPECT_THROW(validate(c), KeyError);
    c.enable_ptp = false;
    c.offset_s = -1;
    EXPECT_THROW(validate(c), KeyError);
    c.start = ClockStart::kMachine;
    EXPECT_NO_THROW(validate(c));
}

}  // namespace
}  // namespace hilcam
