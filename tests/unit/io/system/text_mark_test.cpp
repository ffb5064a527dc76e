#include "io/system/text_mark.h"

#include <gmock/gmock.h>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

using namespace std::string_literals;

TEST(TextMark, OfUtf8IsNoPartOfTheText) {
    EXPECT_EQ(without_mark("\xEF\xBB\xBFv 1", "m.obj"), "v 1");
    EXPECT_EQ(without_mark("v 1", "m.obj"), "v 1");
    EXPECT_EQ(without_mark("", "m.obj"), "");
    EXPECT_EQ(without_mark("a\0b"s, "m.obj"), "a\0b"s);  // a zero alone is no wide letter
}

TEST(TextMark, WideLettersAreNamed) {
    for (const std::string& text : {"\xFF\xFEv\0"s, "\xFE\xFF\0v"s, "v\0 \0"s, "\0v\0 "s}) try {
            without_mark(text, "m.obj");
            ADD_FAILURE() << text;
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(),
                        testing::HasSubstr(
                            "m.obj: found a text of wide letters (UTF-16 or UTF-32); accepted: UTF-8"));
        }
}

// U+00FC, U+20AC and U+1F6F0, which has two units.
TEST(TextMark, Utf16BecomesUtf8) {
    const std::string text = "a\xC3\xBC\xE2\x82\xAC\xF0\x9F\x9B\xB0";
    EXPECT_EQ(in_utf8("\xFF\xFE"
                      "a\0\xFC\0\xAC\x20\x3D\xD8\xF0\xDE"s),
              text);
    EXPECT_EQ(in_utf8("\xFE\xFF\0a\0\xFC\x20\xAC\xD8\x3D\xDE\xF0"s), text);
    EXPECT_EQ(in_utf8("a\0b\0"s), "ab");
    EXPECT_EQ(in_utf8("\0a\0b"s), "ab");
    EXPECT_EQ(in_utf8("\xEF\xBB\xBF" + text), text);
    EXPECT_EQ(in_utf8(text), text);
    EXPECT_EQ(in_utf8("\xFF\xFE\x3D\xD8"
                      "a\0"s),
              "\xEF\xBF\xBD"
              "a");  // half of a pair
    EXPECT_EQ(in_utf8("\xFF\xFE"
                      "a\0b"s),
              "a");  // half of a unit
}

}  // namespace
}  // namespace hilcam
