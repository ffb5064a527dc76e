#include "emulator/loop/missed_exposures.h"

#include <gtest/gtest.h>

namespace hilcam {
namespace {

TEST(MissedExposures, AGapNamesItsFirstFrame) {
    MissedExposures missed;
    missed.note(1, 0, false, 1000);
    EXPECT_EQ(missed.gap_count(), 0u);
    missed.note(5, 3, false, 5000);  // 2, 3 and 4
    missed.note(6, 0, true, 6000);
    ASSERT_EQ(missed.gaps().size(), 2u);
    EXPECT_EQ(missed.gaps()[0].frame, 2u);
    EXPECT_EQ(missed.gaps()[0].exposures, 3u);
    EXPECT_FALSE(missed.gaps()[0].late);
    EXPECT_EQ(missed.gaps()[0].before_mid_tai_ns, 5000);
    EXPECT_EQ(missed.gaps()[1].frame, 6u);
    EXPECT_EQ(missed.gaps()[1].exposures, 1u);
    EXPECT_TRUE(missed.gaps()[1].late);
    EXPECT_EQ(missed.counted(), 4u);
    EXPECT_EQ(missed.first_counted(), 2u);
}

TEST(MissedExposures, OnlyThoseFromAFrameOnCount) {
    MissedExposures missed(11);
    missed.note(10, 4, false, 0);  // 6 to 9
    EXPECT_EQ(missed.counted(), 0u);
    EXPECT_EQ(missed.first_counted(), 0u);
    missed.note(14, 3, false, 0);  // 11 to 13
    EXPECT_EQ(missed.counted(), 3u);
    EXPECT_EQ(missed.first_counted(), 11u);
    MissedExposures across(11);
    across.note(14, 6, false, 0);  // 8 to 13, of which three count
    EXPECT_EQ(across.counted(), 3u);
    EXPECT_EQ(across.first_counted(), 11u);
    EXPECT_EQ(across.gaps()[0].frame, 8u);  // the list has all
}

TEST(MissedExposures, TheListIsBoundedAndTheCountIsNot) {
    MissedExposures missed;
    for (std::uint64_t i = 1; i <= 1000; ++i) missed.note(10 * i, 2, false, 0);
    EXPECT_EQ(missed.gaps().size(), MissedExposures::kMaxGaps);
    EXPECT_EQ(missed.gaps().back().frame, 10 * MissedExposures::kMaxGaps - 2);
    EXPECT_EQ(missed.gap_count(), 1000u);
    EXPECT_EQ(missed.counted(), 2000u);
}

}  // namespace
}  // namespace hilcam
