#include "io/gige/stream/frame_spacing.h"

#include <gmock/gmock.h>

#include <vector>

#include "io/gige/stream/resend_budget.h"

namespace hilcam {
namespace {

using testing::ElementsAre;

constexpr std::int64_t kMs = 1'000'000, kPeriod_ns = 20 * kMs, kStart_ns = 1'000'000 * kMs;

struct Ready {
    std::int64_t mid_ns, ready_ns;  // after kStart_ns
};

// Returns when frames begin, by a clock that is given: each at its turn, or when the one before it is sent [ms].
std::vector<std::int64_t> begins_ms(const std::vector<Ready>& frames,
                                    std::int64_t longest_period_ns = kPeriod_ns,
                                    std::int64_t takes_ns = kMs) {
    FrameSpacing spacing;
    std::vector<std::int64_t> begins;
    std::int64_t now_ns = kStart_ns;
    for (const Ready& frame : frames) {
        now_ns = std::max(now_ns, kStart_ns + frame.ready_ns);
        now_ns = std::max(now_ns, spacing.earliest_ns(kStart_ns + frame.mid_ns, longest_period_ns, now_ns));
        spacing.begun(kStart_ns + frame.mid_ns, now_ns);
        begins.push_back((now_ns - kStart_ns) / kMs);
        now_ns += takes_ns;
    }
    return begins;
}

// At 50 Hz, each 30 ms after its exposure's middle.
std::vector<Ready> on_time(int count, std::int64_t later_ns = 0) {
    std::vector<Ready> frames;
    for (int i = 0; i < count; ++i)
        frames.push_back({i * kPeriod_ns + later_ns, i * kPeriod_ns + later_ns + 30 * kMs});
    return frames;
}

TEST(FrameSpacing, FramesOnTimeNeverWait) {
    EXPECT_THAT(begins_ms(on_time(4)), ElementsAre(30, 50, 70, 90));
    // Nor where one takes its whole half of the period, nor where one is later than others by a bit less than that.
    EXPECT_THAT(begins_ms(on_time(4), kPeriod_ns, 10 * kMs), ElementsAre(30, 50, 70, 90));
    auto frames = on_time(4);
    frames[1].ready_ns += 9 * kMs;
    EXPECT_THAT(begins_ms(frames), ElementsAre(30, 59, 70, 90));
}

TEST(FrameSpacing, LateOnesCatchUpAtTwiceTheirRate) {
    auto frames = on_time(8);
    for (int i = 1; i < 5; ++i) frames[static_cast<std::size_t>(i)].ready_ns = (120 + i) * kMs;
    EXPECT_THAT(begins_ms(frames), ElementsAre(30, 121, 131, 141, 151, 161, 171, 181));
}

TEST(FrameSpacing, AGapOfSkippedExposuresIsNoPeriod) {
    const std::vector<Ready> frames = {{0, 200 * kMs}, {180 * kMs, 205 * kMs}, {200 * kMs, 206 * kMs}};
    EXPECT_THAT(begins_ms(frames), ElementsAre(200, 210, 220));
    // Without a known rate the exposures' own times count alone.
    EXPECT_THAT(begins_ms(frames, 0), ElementsAre(200, 290, 300));
}

TEST(FrameSpacing, TriggersFasterThanTheFrameRateAreTheirOwnMeasure) {
    std::vector<Ready> frames;
    for (int i = 0; i < 4; ++i) frames.push_back({i * 4 * kMs, i * 4 * kMs + 30 * kMs});
    EXPECT_THAT(begins_ms(frames), ElementsAre(30, 34, 38, 42));
}

TEST(FrameSpacing, WhatIsBeforeItsTimeOrHasNoneIsNotLate) {
    // A replay as fast as it goes: exposures are still to come.
    EXPECT_THAT(begins_ms({{1000 * kMs, 1 * kMs}, {1020 * kMs, 2 * kMs}, {1040 * kMs, 3 * kMs}}),
                ElementsAre(1, 2, 3));
    // A frame that is repeated has the time of the one before; time may be set back.
    EXPECT_THAT(begins_ms({{10 * kMs, 50 * kMs}, {10 * kMs, 51 * kMs}, {5 * kMs, 52 * kMs}}),
                ElementsAre(50, 51, 52));
}

TEST(ResendBudget, TakesWhatIsSavedAndThenWhatIsEarned) {
    ResendBudget budget;
    EXPECT_EQ(budget.left(), 0u);
    budget.restart(10);
    EXPECT_EQ(budget.left(), 40u);
    budget.earn(10);
    EXPECT_EQ(budget.left(), 40u);
    budget.spend(35);
    EXPECT_EQ(budget.left(), 5u);
    budget.spend(6);
    EXPECT_EQ(budget.left(), 0u);
    // A client that asks for every frame once goes on for ever.
    for (int i = 0; i < 100; ++i) {
        budget.earn(10);
        ASSERT_EQ(budget.left(), 10u);
        budget.spend(10);
    }
}

}  // namespace
}  // namespace hilcam
