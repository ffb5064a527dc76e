#include "emulator/bench/soak.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "emulator/bench/soak_report.h"
#include "emulator/loop/latency.h"
#include "io/system/resident_memory.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

TEST(Trend, OfALineIsItsSlope) {
    std::vector<double> line(20);
    std::iota(line.begin(), line.end(), 3.0);
    EXPECT_DOUBLE_EQ(trend_of(line).per_step, 1);
    // n (n - 1) / 2 = 190 pairs rise; n (n - 1) (2n + 5) / 18 = 950.
    EXPECT_NEAR(trend_of(line).sigma, 189 / std::sqrt(950.0), 1e-12);
    std::reverse(line.begin(), line.end());
    EXPECT_DOUBLE_EQ(trend_of(line).per_step, -1);
    EXPECT_NEAR(trend_of(line).sigma, -189 / std::sqrt(950.0), 1e-12);
}

TEST(Trend, OutliersDoNotMatter) {
    std::vector<double> line(21);
    std::iota(line.begin(), line.end(), 0.0);
    line[3] = 1e6, line[17] = -1e6;
    EXPECT_NEAR(trend_of(line).per_step, 1, 0.05);
}

// Six figures in three groups of 2, 3 and 1: variance (6*5*17 - 2*1*9 - 3*2*11) / 18 = 426 / 18. Of the 15
// pairs 4 are ties, 2*3 + 2*1 + 3*1 = 11 rise.
TEST(Trend, TiesAreNoTrendAndNarrowTheVariance) {
    const std::vector<double> values = {1, 1, 2, 2, 2, 5};
    EXPECT_NEAR(trend_of(values).sigma, 10 / std::sqrt(426.0 / 18), 1e-12);
    const std::vector<double> constant(10, 4.0);
    EXPECT_EQ(trend_of(constant).sigma, 0);
    EXPECT_EQ(trend_of(constant).per_step, 0);
    EXPECT_EQ(trend_of({}).sigma, 0);
}

TEST(Trend, FewerThanTheLeastAreNeverSignificant) {
    for (std::size_t n = 2; n <= kMinForTrend; ++n) {
        std::vector<double> line(n);
        std::iota(line.begin(), line.end(), 0.0);
        EXPECT_EQ(trend_of(line).sigma >= kSignificant_sigma, n == kMinForTrend) << n;
    }
}

TEST(DurationHistogram, DifferencesOfItsBucketsAreWhatCameInBetween) {
    DurationHistogram histogram;
    DurationHistogram::Counts before, after;
    for (int i = 0; i < 100; ++i) histogram.record(50'000'000);
    histogram.read(before);
    for (int i = 0; i < 100; ++i) histogram.record(5'000'000);
    histogram.read(after);
    EXPECT_EQ(std::accumulate(after.begin(), after.end(), 0u), 200u);
    for (std::size_t i = 0; i < after.size(); ++i) after[i] -= before[i];
    EXPECT_EQ(std::accumulate(after.begin(), after.end(), 0u), 100u);
    EXPECT_NEAR(DurationHistogram::quantile_ms(after, 1), 5, 0.022 * 5);
    EXPECT_EQ(DurationHistogram::quantile_ms(DurationHistogram::Counts{}, 0.5), 0);
    histogram.clear();
    EXPECT_EQ(histogram.count(), 0u);
    EXPECT_EQ(histogram.quantile_ms(0.5), 0);
}

TEST(ResidentMemory, SeesWhatIsTouched) {
    const ResidentMemory memory;
    const double before_mb = memory.megabytes();
    EXPECT_GT(before_mb, 1);
    constexpr std::size_t kBytes = 64'000'000;
    std::vector<char> block(kBytes, 1);
    // The kernel adds pages up per core in batches (percpu_counter): some may not have been told yet.
    EXPECT_NEAR(memory.megabytes() - before_mb, kBytes * 1e-6, 4);
    EXPECT_EQ(std::count(block.begin(), block.end(), 1), static_cast<std::ptrdiff_t>(kBytes));
}

// Slices of a minute: memory and latency by slice, with a wave on the latency that is no trend.
Soak made_up(std::size_t count, double (*memory_mb)(double), double (*latency_ms)(double)) {
    Soak soak;
    soak.slice_s = 60, soak.round_s = 60;
    for (std::size_t i = 0; i < count; ++i) {
        const auto k = static_cast<double>(i);
        SoakSlice slice;
        slice.start_s = 60 * k, slice.length_s = 60, slice.frames = 1800;
        slice.memory_mb = memory_mb(k);
        const double ms = latency_ms(k) * (1 + 0.02 * std::sin(2.4 * k));
        slice.latency = {ms, 1.5 * ms, 2 * ms, 3 * ms};
        soak.slices.push_back(slice);
    }
    soak.whole.frames = 1800 * count, soak.whole.length_s = 60 * static_cast<double>(count);
    return soak;
}
double ten(double) { return 10; }

TEST(Soak, FlatAndSteadyIsToldSo) {
    const Soak soak = made_up(
        60, [](double k) { return 200 + 0.1 * std::fmod(k, 3); }, ten);
    EXPECT_TRUE(judge(soak).enough);
    EXPECT_TRUE(judge(soak).memory_flat);
    EXPECT_TRUE(judge(soak).latency_steady);
    EXPECT_THAT(soak_text(soak), HasSubstr("108000 frames in 3600 s"));
    EXPECT_THAT(soak_text(soak), HasSubstr("memory flat: 200.00 to 200.20 MB"));
    EXPECT_THAT(soak_text(soak), HasSubstr("latency steady: p50 10.00 to"));
}

TEST(Soak, ALeakIsSeen) {
    // The smallest block of the heap, 32 bytes, for each of 30 frames a second.
    const SoakVerdict leak = judge(made_up(
        60, [](double k) { return 200 + 60 * 30 * 32e-6 * k; }, ten));
    EXPECT_FALSE(leak.memory_flat);
    EXPECT_NEAR(leak.memory_mb.per_hour, 3600 * 30 * 32e-6, 1e-9);
    EXPECT_NEAR(leak.memory_mb.growth, 59 * 60 * 30 * 32e-6, 1e-9);
    EXPECT_TRUE(leak.latency_steady);
    // All at once, and near the end.
    EXPECT_FALSE(judge(made_up(
                           60, [](double k) { return k < 55 ? 200.0 : 203.0; }, ten))
                     .memory_flat);
}

TEST(Soak, ASlowDriftOfLatencyIsSeen) {
    const Soak soak = made_up(60, ten, [](double k) { return 10 + 0.02 * k; });
    EXPECT_FALSE(judge(soak).latency_steady);
    EXPECT_NEAR(judge(soak).latency_p50_ms.growth, 59 * 0.02, 0.1);
    EXPECT_THAT(soak_text(soak), HasSubstr("latency drifts"));
    // Significant, but less than anybody would care for.
    const Soak small = made_up(60, ten, [](double k) { return 10 + 0.005 * k; });
    EXPECT_GT(judge(small).latency_p50_ms.sigma, kSignificant_sigma);
    EXPECT_TRUE(judge(small).latency_steady);
}

TEST(Soak, TooFewSlicesAreNotJudged) {
    const Soak soak = made_up(
        6, [](double k) { return 200 + 10 * k; }, ten);
    EXPECT_FALSE(judge(soak).enough);
    EXPECT_THAT(soak_text(soak), HasSubstr("memory not judged: 200.00 to 250.00 MB"));
    EXPECT_THAT(soak_text(soak), HasSubstr("a trend takes 7 slices, there are 6"));
    EXPECT_TRUE(soak_json({}, {}, soak)["verdict"]["memory_flat"].is_null());
}

}  // namespace
}  // namespace hilcam
