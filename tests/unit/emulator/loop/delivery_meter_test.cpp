#include "emulator/loop/delivery_meter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace hilcam {
namespace {

constexpr std::int64_t kMs = 1'000'000;

// A frame whose exposure is in the middle at 1 s, whose command came before that, and that is sent after it.
FrameRecord frame(std::uint64_t id, std::int64_t command_before_ms = 0) {
    FrameRecord record;
    record.id = id;
    record.exposure_mid_monotonic_ns = 1'000 * kMs;
    record.exposure_mid = {static_cast<std::int64_t>(id) * 7};
    if (command_before_ms > 0)
        record.command_arrival_monotonic_ns = record.exposure_mid_monotonic_ns - command_before_ms * kMs;
    return record;
}

std::vector<std::uint64_t> ids(std::span<const LatestFrames::Entry> entries) {
    std::vector<std::uint64_t> out;
    for (const auto& entry : entries) out.push_back(entry.delivery.frame);
    return out;
}

TEST(OutputMeter, StepsAddUpToTheTimesFromCommandAndExposure) {
    DeliveryMeter all;
    OutputMeter meter(all, {}, true);
    meter.delivered(frame(1, 4), 1'010 * kMs, 1'012 * kMs);
    EXPECT_DOUBLE_EQ(all.command_to_exposure.max_ms(), 4);
    EXPECT_DOUBLE_EQ(all.exposure_to_first.max_ms(), 10);
    EXPECT_DOUBLE_EQ(all.first_to_last.max_ms(), 2);
    EXPECT_DOUBLE_EQ(all.command_to_first.max_ms(), 14);
    EXPECT_DOUBLE_EQ(all.command_to_last.max_ms(), 16);
    EXPECT_DOUBLE_EQ(all.exposure_to_last.max_ms(), 12);
}

TEST(OutputMeter, AFrameWithoutANewCommandHasOnlyTheTimesFromItsExposure) {
    DeliveryMeter all;
    OutputMeter meter(all, {}, true);
    meter.delivered(frame(20), 1'010 * kMs, 1'012 * kMs);
    EXPECT_EQ(all.command_to_last.count() + all.command_to_first.count() + all.command_to_exposure.count(),
              0u);
    EXPECT_EQ(all.judged.count(), 0u);
    EXPECT_TRUE(meter.from_command().entries().empty());
    EXPECT_EQ(ids(meter.from_exposure().entries()), std::vector<std::uint64_t>{20});
}

TEST(OutputMeter, ACommandInTheSecondHalfOfAnExposureTakesNoTimeToIt) {
    DeliveryMeter all;
    OutputMeter meter(all, {}, true);
    FrameRecord record = frame(1, 1);
    record.command_arrival_monotonic_ns = record.exposure_mid_monotonic_ns + kMs;
    meter.delivered(record, 1'010 * kMs, 1'012 * kMs);
    EXPECT_EQ(all.command_to_exposure.max_ms(), 0);
    EXPECT_EQ(all.command_to_exposure.count(), 1u);
    EXPECT_DOUBLE_EQ(all.command_to_last.max_ms(), 11);
}

// In lockstep the exposure has no time on the machine's clock.
TEST(OutputMeter, WithoutAClockThereAreNoTimesFromTheExposure) {
    DeliveryMeter all;
    OutputMeter meter(all, {}, false);
    meter.delivered(frame(12, 4), 1'010 * kMs, 1'012 * kMs);
    EXPECT_EQ(all.exposure_to_last.count() + all.exposure_to_first.count() + all.command_to_exposure.count(),
              0u);
    EXPECT_DOUBLE_EQ(all.command_to_last.max_ms(), 16);
}

TEST(OutputMeter, TheTenLatestFramesAreKeptByTheirIds) {
    DeliveryMeter all;
    OutputMeter meter(all, {}, true);
    // Latencies of 12 + (id * 37 mod 100) ms: all different.
    const auto late_ms = [](std::uint64_t id) { return static_cast<std::int64_t>(id * 37 % 100); };
    for (std::uint64_t id = 1; id <= 100; ++id)
        meter.delivered(frame(id), (1'010 + late_ms(id)) * kMs, (1'012 + late_ms(id)) * kMs);
    const auto latest = merged(meter.from_exposure().entries(), {});
    ASSERT_EQ(latest.size(), LatestFrames::kMax);
    for (std::size_t i = 0; i < latest.size(); ++i) {
        EXPECT_EQ(latest[i].latency_ns, (12 + 99 - static_cast<std::int64_t>(i)) * kMs);
        EXPECT_EQ(late_ms(latest[i].delivery.frame), 99 - static_cast<std::int64_t>(i));
        EXPECT_EQ(latest[i].delivery.exposure_mid.ns,
                  static_cast<std::int64_t>(latest[i].delivery.frame) * 7);
    }
}

TEST(OutputMeter, TheLatestOfTwoOutputsAreTheLatestOfBoth) {
    DeliveryMeter all;
    OutputMeter one(all, {}, true), two(all, {}, true);
    for (std::uint64_t id = 1; id <= 8; ++id) {
        const auto ms = static_cast<std::int64_t>(id);
        one.delivered(frame(id), 1'000 * kMs, (1'000 + ms) * kMs);
        two.delivered(frame(100 + id), 1'000 * kMs, (1'000 + 2 * ms) * kMs);
    }
    EXPECT_EQ(ids(merged(one.from_exposure().entries(), two.from_exposure().entries())),
              (std::vector<std::uint64_t>{108, 107, 106, 105, 8, 104, 7, 6, 103, 5}));
    EXPECT_EQ(all.exposure_to_last.count(), 16u);
}

TEST(OutputMeter, BoundsCountFromTheirFirstFrame) {
    RunBounds bounds;
    bounds.latency_s = 10e-3, bounds.exposure_latency_s = 4e-3, bounds.from_frame = 5;
    DeliveryMeter all;
    OutputMeter meter(all, bounds, true);
    meter.delivered(frame(4, 900), 1'000 * kMs, 1'003 * kMs);  // before the first that counts
    EXPECT_EQ(all.judged.count() + meter.judged_exposures(), 0u);
    meter.delivered(frame(5, 7), 1'000 * kMs, 1'003 * kMs);  // 10 ms: as much as is allowed
    EXPECT_EQ(meter.above_latency().frames, 0u);
    EXPECT_EQ(meter.above_latency().max_ns, 10 * kMs);
    meter.delivered(frame(6, 8), 1'000 * kMs, 1'003 * kMs);
    meter.delivered(frame(7), 1'000 * kMs, 1'005 * kMs);
    meter.delivered(frame(8, 20), 1'000 * kMs, 1'003 * kMs);
    EXPECT_EQ(meter.above_latency().first, 6u);
    EXPECT_EQ(meter.above_latency().frames, 2u);
    EXPECT_EQ(meter.above_latency().max_ns, 23 * kMs);
    EXPECT_EQ(meter.above_exposure().first, 7u);
    EXPECT_EQ(meter.above_exposure().frames, 1u);
    EXPECT_EQ(meter.judged_exposures(), 4u);
    EXPECT_EQ(all.judged.count(), 3u);
    EXPECT_EQ(all.command_to_last.count(), 4u);  // the report has all of them
}

}  // namespace
}  // namespace hilcam
