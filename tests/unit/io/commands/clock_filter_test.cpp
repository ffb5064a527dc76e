#include "io/commands/clock_filter.h"

#include <gtest/gtest.h>

#include <limits>

namespace hilcam {
namespace {

constexpr std::int64_t kOffset_ns = 1'000'000'000;  // the machine's clock is a second ahead

// There in so long, answered at once after 10, back in so long.
ClockExchange exchange(std::int64_t sent_ns, std::int64_t there_ns, std::int64_t back_ns) {
    ClockExchange x;
    x.sent_ns = sent_ns;
    x.reading.arrival_monotonic_ns = sent_ns + there_ns + kOffset_ns;
    x.reading.departure_monotonic_ns = x.reading.arrival_monotonic_ns + 10;
    x.received_ns = sent_ns + there_ns + 10 + back_ns;
    return x;
}

TEST(ClockFilter, OffsetAndDelayAreThoseOfTheFourInstants) {
    ClockFilter filter;
    EXPECT_FALSE(filter.estimate(0));
    EXPECT_FALSE(filter.simulated_at(0));
    ASSERT_TRUE(filter.take(exchange(0, 100, 100)));
    EXPECT_EQ(filter.estimate(210)->offset_ns, kOffset_ns);
    EXPECT_EQ(filter.estimate(210)->delay_ns, 200);
    EXPECT_DOUBLE_EQ(filter.estimate(210)->error_ns, 100);
    // Unequal ways: half of their difference, and within the error.
    ClockFilter uneven;
    ASSERT_TRUE(uneven.take(exchange(0, 300, 100)));
    EXPECT_EQ(uneven.estimate(410)->offset_ns, kOffset_ns + 100);
    EXPECT_DOUBLE_EQ(uneven.estimate(410)->error_ns, 200);
}

TEST(ClockFilter, TheQuickestOfTheLastEightCountsAndAgesBy15Ppm) {
    ClockFilter filter;
    filter.take(exchange(0, 1'000, 1'000));
    filter.take(exchange(10'000, 100, 100));
    filter.take(exchange(20'000, 5'000, 1'000));
    EXPECT_EQ(filter.estimate(30'000)->delay_ns, 200);
    // 100 ns + 15 ppm of a second; the slower ones have aged as much.
    EXPECT_NEAR(filter.estimate(10'210 + 1'000'000'000)->error_ns, 100 + 15'000, 1e-6);
    for (int i = 0; i < 6; ++i) filter.take(exchange(40'000 + i, 2'000, 2'000));
    EXPECT_EQ(filter.estimate(50'000)->delay_ns, 200);  // the eighth
    filter.take(exchange(60'000, 2'000, 2'000));
    EXPECT_EQ(filter.estimate(70'000)->delay_ns, 4'000);  // gone
    // One of 3 us is better than one of 2 us that is a minute older: that may have drifted by 0.9 ms.
    ClockFilter old;
    old.take(exchange(0, 1'000, 1'000));
    old.take(exchange(60'000'000'000, 1'500, 1'500));
    EXPECT_EQ(old.estimate(60'000'010'000)->delay_ns, 3'000);
}

TEST(ClockFilter, AnAnswerBeforeItsQuestionIsNotTaken) {
    ClockFilter filter;
    EXPECT_FALSE(filter.take(exchange(1'000, -600, -600)));
    ClockExchange x = exchange(0, 10, 10);
    x.reading.departure_monotonic_ns -= 20;
    EXPECT_FALSE(filter.take(x));
    x = exchange(0, 10, 10);
    x.reading.arrival_monotonic_ns -= 100'000;  // "answered" for longer than it was away
    EXPECT_FALSE(filter.take(x));
    EXPECT_FALSE(filter.estimate(0));
}

TEST(ClockFilter, SimulatedTimeGoesOnAsTheNewestAnswerSays) {
    ClockFilter filter;
    ClockExchange x = exchange(0, 100, 100);
    x.reading.departure.ns = 5'000;
    x.reading.scale = 0.5;
    ASSERT_TRUE(filter.take(x));
    // Departed at the sender's 110.
    EXPECT_EQ(filter.simulated_at(110)->ns, 5'000);
    EXPECT_EQ(filter.simulated_at(2'110)->ns, 6'000);
    EXPECT_EQ(filter.simulated_at(-1'890)->ns, 4'000);
    x = exchange(10'000, 100, 100);
    x.reading.departure.ns = 9'000;
    x.reading.stands_at.ns = 9'500;
    ASSERT_TRUE(filter.take(x));
    EXPECT_EQ(filter.simulated_at(10'310)->ns, 9'200);
    EXPECT_EQ(filter.simulated_at(20'000)->ns, 9'500);
}

// From the wire: any bytes. Nothing overflows (a sanitizer would see it).
TEST(ClockFilter, ClocksOfAnyEpochAreTaken) {
    constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min(),
                           kMax = std::numeric_limits<std::int64_t>::max();
    const std::int64_t values[] = {kMin, kMin + 1, -1, 0, 1, kMax - 1, kMax};
    std::size_t taken = 0;
    for (const std::int64_t sent : values)
        for (const std::int64_t arrival : values)
            for (const std::int64_t departure : values)
                for (const std::int64_t received : values) {
                    ClockFilter filter;
                    ClockExchange x;
                    x.sent_ns = sent, x.received_ns = received;
                    x.reading.arrival_monotonic_ns = arrival, x.reading.departure_monotonic_ns = departure;
                    x.reading.scale = 1e300;
                    x.reading.departure.ns = arrival;
                    taken += filter.take(x);
                    filter.simulated_at(kMin), filter.simulated_at(kMax);
                }
    EXPECT_GT(taken, 0u);
    // The epochs cancel.
    ClockFilter filter;
    ClockExchange x;
    x.sent_ns = kMax - 1'000, x.received_ns = kMax - 790;
    x.reading.arrival_monotonic_ns = kMin + 100, x.reading.departure_monotonic_ns = kMin + 110;
    ASSERT_TRUE(filter.take(x));
    EXPECT_EQ(filter.estimate(kMax)->delay_ns, 200);
}

}  // namespace
}  // namespace hilcam
