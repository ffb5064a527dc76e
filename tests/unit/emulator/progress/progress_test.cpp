// The words of the progress line. That it is written over on a terminal, and comes line by line elsewhere, is tested on
// the program itself (tests/protocol/run_program_test.py).

#include "emulator/progress/progress_line.h"

#include <gtest/gtest.h>

namespace hilcam {
namespace {

TEST(ProgressLine, TellsTimeAsPeopleDo) {
    EXPECT_EQ(duration_text(0), "0 s");
    EXPECT_EQ(duration_text(7.2), "8 s");
    EXPECT_EQ(duration_text(59.5), "1 min");
    EXPECT_EQ(duration_text(125), "2 min 5 s");
    EXPECT_EQ(duration_text(3785), "1 h 3 min");
}

TEST(ProgressLine, WhatIsLeftGoesByThePaceSoFar) {
    EXPECT_NEAR(*left_s({"", 0.25, 10}), 30, 1e-12);
    EXPECT_EQ(*left_s({"", 1.0, 10}), 0);
    EXPECT_FALSE(left_s({"", 0.25, 0.5})) << "too soon to tell";
    EXPECT_FALSE(left_s({"", 0.001, 60})) << "too little to tell by";
    EXPECT_FALSE(left_s({"", {}, 60})) << "nobody knows how much there is";
}

TEST(ProgressLine, HasTheOutermostWorkAndTheInnermost) {
    const ProgressItem outer{"tradeoff", 0.345, 12}, middle{"reference", 0.5, 3},
        inner{"loading a.glb", {}, 2};
    EXPECT_EQ(progress_text({outer}, 80), "tradeoff 34 %, 12 s, about 23 s left");
    EXPECT_EQ(progress_text({outer, middle, inner}, 80),
              "tradeoff 34 %, 12 s, about 23 s left: loading a.glb");
    EXPECT_EQ(progress_text({inner}, 80), "loading a.glb, 2 s");
}

TEST(ProgressLine, WorkThatHasHardlyBegunDoesNotStandAtNought) {
    EXPECT_EQ(progress_text({{"bench", 0.0, 12}, {"light kept on sat", 0.009, 11}}, 80),
              "bench, 12 s: light kept on sat");
    EXPECT_EQ(progress_text({{"bench", 0.01, 12}}, 80), "bench 1 %, 12 s, about 19 min 48 s left");
}

TEST(ProgressLine, ALogHasOneEachThirtySecondsUnlessToldOtherwise) {
    EXPECT_EQ(seconds_between_lines(nullptr), 30);
    EXPECT_EQ(seconds_between_lines("5"), 5);
    EXPECT_EQ(seconds_between_lines("0"), 0);
    for (const char* const none : {"", "often", "-1", "nan"})
        EXPECT_EQ(seconds_between_lines(none), 30) << none;
    EXPECT_EQ(seconds_between_lines("1e-9"), 0.1);
}

TEST(ProgressLine, IsOneLineThatMakesATerminalDoNothing) {
    EXPECT_EQ(progress_text({{"a\x1b[2Jb\nc", {}, 1}}, 80), "a [2Jb c, 1 s");
    EXPECT_EQ(progress_text({{"a name that is long", {}, 1}}, 10), "a name tha");
    // Cut within a character, it is still UTF-8.
    EXPECT_EQ(progress_text({{"\xc3\xa9\xc3\xa9", {}, 1}}, 3), "\xc3\xa9 ");
}

}  // namespace
}  // namespace hilcam
