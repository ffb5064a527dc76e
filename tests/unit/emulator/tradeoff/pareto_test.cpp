#include "emulator/tradeoff/pareto.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace hilcam {
namespace {

using Indices = std::vector<std::size_t>;

//                                      0       1       2       3       4          5       6
const std::vector<TimedError> kPoints = {{10, 1}, {5, 3}, {7, 2}, {8, 2}, {12, 0.99}, {5, 4}, {20, 0.1}};

TEST(Pareto, FrontIsWhatNoOtherBeatsInBoth) {
    EXPECT_EQ(pareto_front(kPoints), (Indices{1, 2, 0, 4, 6}));
    EXPECT_EQ(pareto_front({}), Indices{});
    // Of equal ones the first.
    const std::vector<TimedError> equal = {{1, 1}, {1, 1}};
    EXPECT_EQ(pareto_front(equal), Indices{0});
}

TEST(Pareto, StepsThatGainTooLittleAreLeftOut) {
    EXPECT_EQ(pareto_front(kPoints, 0.02), (Indices{1, 2, 0, 6}));
}

TEST(Pareto, FrontsFollowOneAnotherEachSpreadFromItsBeginning) {
    // Five on the front, by time 1 2 0 4 6, at places 0 4 2 1 3; behind it 5 and 3.
    EXPECT_EQ(by_fronts(kPoints, 7), (Indices{1, 6, 0, 2, 4, 5, 3}));
    EXPECT_EQ(by_fronts(kPoints, 3), (Indices{1, 6, 0}));
    EXPECT_EQ(by_fronts(kPoints, 100).size(), kPoints.size());
}

TEST(Pareto, RecommendsTheBestThatKeepsTheLimit) {
    EXPECT_EQ(best_within_time(kPoints, 10), 0u);
    EXPECT_EQ(best_within_time(kPoints, 9), 2u);
    EXPECT_EQ(best_within_time(kPoints, 4), std::nullopt);
    EXPECT_EQ(fastest_within_error(kPoints, 2.5), 2u);
    EXPECT_EQ(fastest_within_error(kPoints, 1), 0u);
    EXPECT_EQ(fastest_within_error(kPoints, 0.01), std::nullopt);
}

}  // namespace
}  // namespace hilcam
