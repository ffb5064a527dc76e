#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "emulator/loop/latency.h"

namespace hilcam {
namespace {

TEST(DurationHistogram, QuantilesAreRightWithinItsBuckets) {
    std::mt19937 engine(5);
    std::lognormal_distribution<double> distribution(1, 1);
    DurationHistogram histogram;
    std::vector<double> all;
    for (int i = 0; i < 20000; ++i) {
        all.push_back(distribution(engine));
        histogram.record(static_cast<std::int64_t>(all.back() * 1e6));
    }
    std::sort(all.begin(), all.end());
    EXPECT_NEAR(histogram.quantile_ms(0.5) / all[10000], 1, 0.025);
    EXPECT_NEAR(histogram.quantile_ms(0.99) / all[19800], 1, 0.025);
    EXPECT_EQ(DurationHistogram().quantile_ms(0.5), 0);
}

TEST(DurationHistogram, ItsLongestIsExactAndItsBucketsCountEveryRecord) {
    DurationHistogram histogram;
    for (const std::int64_t ns : {1'000'123, 7'654'321, 3'000'000, 1'100'000}) histogram.record(ns);
    EXPECT_DOUBLE_EQ(histogram.max_ms(), 7.654321);
    std::uint64_t count = 0;
    for (const DurationHistogram::Bucket& b : histogram.quarter_octaves()) count += b.count;
    EXPECT_EQ(count, 4u);
    histogram.clear();
    EXPECT_EQ(histogram.max_ms(), 0);
}

}  // namespace
}  // namespace hilcam
