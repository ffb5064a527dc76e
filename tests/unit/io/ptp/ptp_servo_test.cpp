#include "io/ptp/ptp_servo.h"

#include <gtest/gtest.h>

namespace hilcam {
namespace {

constexpr std::int64_t kServoSecond = 1'000'000'000;

// A master whose time is CLOCK_MONOTONIC, 1 ms away.
PathDelay a_millisecond() {
    PathDelay delay;
    delay.add({0, 1'000'000, 2'000'000, 3'000'000});
    return delay;
}

TEST(PathDelay, IsTheMedianOfTheLatestExchanges) {
    PathDelay delay;
    EXPECT_FALSE(delay.known());
    EXPECT_EQ(delay.median_ns(0), 0);
    // Here 500 us pass between t2 and t3, and 700 us between t1 and t4: 100 us each way.
    delay.add({1'000'000, 51'100'000, 51'600'000, 1'700'000});
    EXPECT_EQ(delay.median_ns(0), 100'000);
    delay.add({1'000'000, 51'100'000, 51'600'000, 9'700'000});  // waited 8 ms in a queue
    delay.add({1'000'000, 51'100'000, 51'600'000, 1'702'000});
    EXPECT_EQ(delay.median_ns(0), 101'000);
    for (std::size_t i = 0; i < PathDelay::kKept; ++i) delay.add({0, 0, 0, 14});
    EXPECT_EQ(delay.median_ns(0), 7);
    delay.clear();
    EXPECT_FALSE(delay.known());
}

TEST(PathDelay, KnowsThatTheMastersClockGainsMeanwhile) {
    PathDelay delay;
    // One second passes here, 1.0001 s there: without the rate 50 us would be taken for delay.
    delay.add({0, 0, kServoSecond, kServoSecond + 100'000 + 2'000});
    EXPECT_EQ(delay.median_ns(0), 51'000);
    EXPECT_EQ(delay.median_ns(100e-6), 1'000);
}

TEST(PtpServo, TwoSyncsGiveTheFrequencyAndOneStep) {
    DeviceClock clock({.rate = 80e-6}, {0, 5 * kServoSecond, 0});
    PtpServo servo(clock);
    const PathDelay delay = a_millisecond();
    servo.take(10 * kServoSecond, {10 * kServoSecond - 1'000'000, 10 * kServoSecond, 1}, delay);
    EXPECT_EQ(servo.steps(), 0u);
    servo.take(12 * kServoSecond, {12 * kServoSecond - 1'000'000, 12 * kServoSecond, 1}, delay);
    EXPECT_EQ(servo.steps(), 1u);
    EXPECT_NEAR(servo.rate_correction(), -80e-6, 1e-9);
    EXPECT_NEAR(static_cast<double>(clock.device_ns(100 * kServoSecond) - 100 * kServoSecond), 0,
                600);  // 6.4e-9
    EXPECT_FALSE(servo.locked());
}

TEST(PtpServo, SmallOffsetsAreSlewedNotStepped) {
    DeviceClock clock;
    PtpServo servo(clock);
    const PathDelay delay = a_millisecond();
    std::int64_t last_ns = 0;
    for (std::int64_t t = 1; t <= 60; ++t) {
        // From the 20th second on, the master is 500 us ahead.
        const std::int64_t ahead_ns = t >= 20 ? 500'000 : 0;
        servo.take(t * kServoSecond, {t * kServoSecond - 1'000'000 + ahead_ns, t * kServoSecond, 1}, delay);
        for (std::int64_t ms = 1; ms < 1000; ++ms) {
            const std::int64_t now_ns = t * kServoSecond + ms * 1'000'000,
                               device_ns = clock.device_ns(now_ns);
            servo.tick(now_ns);
            EXPECT_GT(device_ns, last_ns);
            EXPECT_LT(device_ns - last_ns, last_ns == 0 ? 2 * kServoSecond : 2'003'000);
            last_ns = device_ns;
        }
    }
    EXPECT_EQ(servo.steps(), 0u);
    EXPECT_TRUE(servo.locked());
    EXPECT_NEAR(static_cast<double>(clock.device_ns(61 * kServoSecond) - 61 * kServoSecond), 500'000, 50'000);
}

TEST(PtpServo, AMasterThatStepsBetweenTheFirstTwoSyncsIsNotAFrequency) {
    DeviceClock clock;
    PtpServo servo(clock);
    const PathDelay delay = a_millisecond();
    servo.take(1 * kServoSecond, {1 * kServoSecond, 1 * kServoSecond, 1}, delay);
    servo.take(2 * kServoSecond, {900 * kServoSecond, 2 * kServoSecond, 1}, delay);
    EXPECT_EQ(servo.steps(), 0u);
    servo.take(3 * kServoSecond, {901 * kServoSecond, 3 * kServoSecond, 1}, delay);
    EXPECT_EQ(servo.steps(), 1u);
    EXPECT_NEAR(servo.rate_correction(), 0, 1e-9);
}

TEST(PtpServo, ResetForgetsTheRateAndCountsOn) {
    DeviceClock clock({.rate = 80e-6}, {0, 0, 0});
    PtpServo servo(clock);
    const PathDelay delay = a_millisecond();
    for (std::int64_t t = 1; t < 10; ++t)
        servo.take(t * kServoSecond, {t * kServoSecond, t * kServoSecond, 1}, delay);
    EXPECT_TRUE(servo.locked());
    servo.reset(10 * kServoSecond);
    EXPECT_FALSE(servo.locked());
    EXPECT_EQ(servo.steps(), 1u);
    EXPECT_NEAR(clock.line().rate, 80e-6, 1e-12);
}

}  // namespace
}  // namespace hilcam
