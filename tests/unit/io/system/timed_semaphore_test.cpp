// A semaphore's waits end by a release or at their instant, and say which.

#include "io/system/timed_semaphore.h"

#include <gtest/gtest.h>

#include <thread>

namespace hilcam {
namespace {

constexpr std::int64_t kLong_ns = 60'000'000'000, kShort_ns = 2'000'000;

TEST(TimedSemaphore, IsTakenAsOftenAsItWasReleased) {
    TimedSemaphore semaphore;
    EXPECT_FALSE(semaphore.try_acquire());
    semaphore.release(), semaphore.release();
    EXPECT_TRUE(semaphore.try_acquire());
    EXPECT_TRUE(semaphore.try_acquire_until(0)) << "one that is there is taken, however late it is";
    EXPECT_FALSE(semaphore.try_acquire());
    semaphore.release(), semaphore.release(), semaphore.take_all();
    EXPECT_FALSE(semaphore.try_acquire());
}

TEST(TimedSemaphore, AWaitEndsAtItsInstantAndNotBefore) {
    TimedSemaphore semaphore;
    const std::int64_t then_ns = monotonic_ns() + kShort_ns;
    EXPECT_FALSE(semaphore.try_acquire_until(then_ns));
    EXPECT_GE(monotonic_ns(), then_ns);
    EXPECT_FALSE(semaphore.try_acquire_for(-kShort_ns));
}

TEST(TimedSemaphore, AReleaseEndsAWait) {
    TimedSemaphore asked, answered;
    std::thread other([&] {
        for (int i = 0; i < 1000 && asked.try_acquire_for(kLong_ns); ++i) answered.release();
    });
    int answers = 0;
    for (; answers < 1000; ++answers) {
        asked.release();
        if (!answered.try_acquire_for(kLong_ns)) break;
    }
    other.join();
    EXPECT_EQ(answers, 1000);
}

// What one thread wrote before a release, the one that takes it reads.
TEST(TimedSemaphore, AReleasePassesOnWhatWasWritten) {
    TimedSemaphore full, empty;
    int value = 0;
    std::thread other([&] {
        for (int i = 1; i <= 1000; ++i) {
            value = i;
            full.release();
            if (!empty.try_acquire_for(kLong_ns)) return;
        }
    });
    int in_order = 0;
    for (int i = 1; i <= 1000 && full.try_acquire_for(kLong_ns); ++i) {
        in_order += value == i;
        empty.release();
    }
    other.join();
    EXPECT_EQ(in_order, 1000);
}

}  // namespace
}  // namespace hilcam
