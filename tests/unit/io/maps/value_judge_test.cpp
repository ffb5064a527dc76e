#include "io/maps/value_judge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const Figure kMoon{1737.4e3, 1737.4e3};

TEST(ValueJudge, NumbersOfHabitAreHolesWhereTheyStandAlone) {
    EXPECT_THAT(unsaid_holes(std::vector<float>{10, -9999, 2000, -1500}), ElementsAre(-9999));
    EXPECT_THAT(unsaid_holes(std::vector<float>{0, -32768, 0, -9999}), ElementsAre(-9999, -32768));
    EXPECT_THAT(unsaid_holes(std::vector<float>{0.1F, 0.2F, -999}), ElementsAre(-999));
    // A deep sea, and LOLA's numbers of half metres, have such heights.
    EXPECT_THAT(unsaid_holes(std::vector<float>{-10500, -9999, -9000, 3000}), IsEmpty());
    EXPECT_THAT(unsaid_holes(std::vector<float>{-9998, -9999, 20000}), IsEmpty());
    EXPECT_THAT(unsaid_holes(std::vector<float>{-9999, -9999}), IsEmpty());
    EXPECT_THAT(unsaid_holes({}), IsEmpty());
}

TEST(ValueJudge, HeightsThatAreRadiiAreRefusedWithTheOffset) {
    std::vector<std::string> doubts;
    EXPECT_THAT(judge_heights(std::vector<float>{1733e3F, 1745e3F}, kMoon, true, doubts),
                HasSubstr("offset: -1737400"));
    EXPECT_EQ(judge_heights(std::vector<float>{-9000, 10700}, kMoon, true, doubts), "");
    EXPECT_THAT(doubts, IsEmpty());
}

TEST(ValueJudge, HeightsOfAnotherUnitAreDoubted) {
    const auto doubt = [](std::vector<float> heights_m) {
        std::vector<std::string> doubts;
        EXPECT_EQ(judge_heights(heights_m, kMoon, true, doubts), "");
        return doubts.empty() ? "" : doubts[0];
    };
    EXPECT_THAT(doubt({1732, 1741}), HasSubstr("radii in km"));
    EXPECT_THAT(doubt({-9, 10.7F}), HasSubstr("scale: 1000"));
    EXPECT_THAT(doubt({-9e6F, 10.7e6F}), HasSubstr("more than a tenth"));
    EXPECT_EQ(doubt({0, 0}), "");  // a flat body
}

}  // namespace
}  // namespace hilcam
