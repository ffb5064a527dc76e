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

}  // namespace
}  // namespace hilcam
