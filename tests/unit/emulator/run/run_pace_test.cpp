#include "emulator/run/run_pace.h"

#include <gtest/gtest.h>

namespace hilcam {
namespace {

void count(LoopCounters& counters, std::size_t level, std::uint64_t frames, double core_ms) {
    counters.frames.fetch_add(frames);
    counters.frames_at_level[level].fetch_add(frames);
    counters.timed_frames_at_level[level].fetch_add(frames);
    counters.processor_ns_at_level[level].fetch_add(
        static_cast<std::int64_t>(static_cast<double>(frames) * core_ms * 1e6));
}

TEST(FullQuality, CostsWhatItsOwnFramesTook) {
    LoopCounters counters;
    count(counters, 0, 100, 90);
    count(counters, 2, 500, 30);
    EXPECT_NEAR(full_quality_core_ms(counters, {{0, 1}, {0, 1}, {0, 1}}).value(), 90, 1e-9);
}

TEST(FullQuality, ThatNoFrameHadCostsWhatItDidBeforeTheRunByHowMuchMoreTheOthersTook) {
    LoopCounters counters;
    count(counters, 0, 3, 1000);  // too few to say
    count(counters, 1, 300, 60);  // 1.5 times their cost
    count(counters, 2, 100, 30);
    const double load = (3 * 1000.0 + 300 * 60 + 100 * 30) / (3 * 100.0 + 300 * 40 + 100 * 20);
    EXPECT_NEAR(full_quality_core_ms(counters, {{0, 100}, {0, 40}, {0, 20}}).value(), 100 * load, 1e-9);
    // A level whose cost is not known says nothing.
    EXPECT_NEAR(full_quality_core_ms(counters, {{0, 100}, {0, 40}, {0, 0}}).value(),
                100 * (3 * 1000.0 + 300 * 60) / (3 * 100.0 + 300 * 40), 1e-9);
}

TEST(FullQuality, IsUnknownWhereNothingWasMeasured) {
    LoopCounters counters;
    EXPECT_FALSE(full_quality_core_ms(counters, {}));
    EXPECT_FALSE(full_quality_core_ms(counters, {{0, 0}, {0, 10}}));
    EXPECT_NEAR(full_quality_core_ms(counters, {{0, 80}}).value(), 80, 1e-9);
    EXPECT_DOUBLE_EQ((FullQuality{100, 30}.cores()), 3);
}

struct Stages {
    double render_ms, sense_ms, publish_ms;
};
PaceLimit limit_of(const Stages& stages, const Misses& misses, PaceLimit cause = PaceLimit::kFrameRate) {
    StageMeters meters;
    meters.render.record_ms(stages.render_ms);
    meters.sense.record_ms(stages.sense_ms);
    meters.publish.record_ms(stages.publish_ms);
    return pace_limit(misses, meters, cause);
}

TEST(PaceLimit, IsTheLongestStageWhereExposuresAreMissed) {
    constexpr Misses kMany{100, 50};
    EXPECT_EQ(limit_of({40, 10, 1}, kMany), PaceLimit::kRendering);
    EXPECT_EQ(limit_of({20, 30, 1}, kMany), PaceLimit::kSensor);
    EXPECT_EQ(limit_of({20, 10, 60}, kMany), PaceLimit::kOutputs);
    EXPECT_EQ(limit_of({20, 10, 60}, kMany, PaceLimit::kTriggers), PaceLimit::kOutputs);
}

TEST(PaceLimit, IsWhoAsksForFramesWhereHardlyAnyIsMissed) {
    EXPECT_EQ(limit_of({40, 10, 1}, {100, 0}), PaceLimit::kFrameRate);
    EXPECT_EQ(limit_of({40, 10, 1}, {100, 2}), PaceLimit::kFrameRate);
    EXPECT_EQ(limit_of({40, 10, 1}, {100, 3}), PaceLimit::kRendering);
    EXPECT_EQ(limit_of({40, 10, 1}, {100, 0}, PaceLimit::kTriggers), PaceLimit::kTriggers);
    EXPECT_EQ(limit_of({40, 10, 1}, {0, 0}), PaceLimit::kFrameRate);
    EXPECT_EQ(limit_of({40, 10, 1}, {100, 50}, PaceLimit::kCommands), PaceLimit::kCommands);
    EXPECT_EQ(words_of(PaceLimit::kOutputs), "outputs");
}

}  // namespace
}  // namespace hilcam
