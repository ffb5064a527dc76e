#include "render/vocabulary/quoted.h"

#include <gtest/gtest.h>

namespace hilcam {
namespace {

TEST(Quoted, WhatATerminalObeysIsABlank) {
    EXPECT_EQ(harmless("a\x1b]0;title\x07"
                       "b\r\nc\x7f"),
              "a ]0;title b  c ");
    EXPECT_EQ(harmless("\xc2\x9b"
                       "31m"),
              " 31m");  // C1's CSI
    EXPECT_EQ(harmless("\xe2\x80\xae"
                       "gpj.exe"),
              " gpj.exe");  // right-to-left override
    EXPECT_EQ(harmless(std::string_view("a\0b", 3)), "a b");
}

TEST(Quoted, WordsOfAnyLanguageStay) {
    const std::string words = "Sp\xc3\xa4her \xe8\xa1\x9b\xe6\x98\x9f \xf0\x9f\x9b\xb0";
    EXPECT_EQ(harmless(words), words);
}

// Cut off, a lone continuation, longer than it need be, a surrogate, above 10FFFF.
TEST(Quoted, BytesThatAreNoTextAreBlanks) {
    EXPECT_EQ(harmless("a\xc3"), "a ");
    EXPECT_EQ(harmless("\x9b"
                       "31m"),
              " 31m");
    EXPECT_EQ(harmless("\xc0\x9b"), "  ");
    EXPECT_EQ(harmless("\xed\xa0\x80"), "   ");
    EXPECT_EQ(harmless("\xf4\x90\x80\x80"), "    ");
    EXPECT_EQ(harmless("\xff\xfe"), "  ");
}

TEST(Quoted, LongTextIsCutBetweenCharacters) {
    EXPECT_EQ(in_quotes(std::string(60, 'x')), "'" + std::string(60, 'x') + "'");
    EXPECT_EQ(in_quotes(std::string(5000, 'x')), "'" + std::string(57, 'x') + "...'");
    std::string umlauts;
    for (int i = 0; i < 40; ++i) umlauts += "\xc3\xa4";
    EXPECT_EQ(shortened(umlauts), umlauts.substr(0, 56) + "...");
}

}  // namespace
}  // namespace hilcam
