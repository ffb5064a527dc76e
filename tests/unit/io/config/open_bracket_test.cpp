#include "io/config/open_bracket.h"

#include <gtest/gtest.h>

namespace hilcam {
namespace {

TEST(UnpairedBracket, IsFoundWhereItOpens) {
    EXPECT_EQ(unpaired_bracket("a: 1\nb: [1, 2\nc: {d: 3}\n"), "the [ of line 2 is not closed");
    EXPECT_EQ(unpaired_bracket("a: {b: [1, 2}\n"), "the [ of line 1 is not closed");
    EXPECT_EQ(unpaired_bracket("a: [1, 2]\nb: 3]\n"), "the ] of line 2 closes none");
    EXPECT_EQ(unpaired_bracket("a:\n  - {b: 1,\n     c: 2\n"), "the { of line 2 is not closed");
}

TEST(UnpairedBracket, WhatStandsInQuotesAndCommentsIsNone) {
    EXPECT_EQ(unpaired_bracket("a: [1, {b: 2}]\n"), "");
    EXPECT_EQ(unpaired_bracket("a: '['  # and ]\nb: \"{\\\"\"\nc: 'it''s ['\n"), "");
    EXPECT_EQ(unpaired_bracket("name: don't [\n"), "the [ of line 1 is not closed");
    EXPECT_EQ(unpaired_bracket("name: a#b\nlist: [1]\n# [\n"), "");
    EXPECT_EQ(unpaired_bracket(""), "");
    EXPECT_EQ(unpaired_bracket("a: \"never closed [\n"), "");
}

}  // namespace
}  // namespace hilcam
