#include "io/system/plain_words.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace hilcam {
namespace {

using nlohmann::json;

template <class Action>
std::string words_of(const Action& action) {
    try {
        action();
    } catch (const std::exception& problem) {
        return plain_words(problem);
    }
    return "no error";
}

TEST(PlainWords, JsonIsSaidWithoutTheLibrarysMarks) {
    EXPECT_EQ(words_of([] { return json::parse("{\n \"a\": }"); }), "is no JSON at line 2, column 7");
    EXPECT_EQ(words_of([] { return json::parse(""); }), "is no JSON at line 1, column 1");
    EXPECT_EQ(words_of([] { return json::parse("{}").at("case"); }), "key 'case' not found");
    EXPECT_EQ(words_of([] { return json::parse("{\"a\": 1}").at("a").get<std::string>(); }),
              "type must be string, but is number");
}

TEST(PlainWords, AFilesNameComesWithTheSystemsReason) {
    EXPECT_EQ(words_of([] { return std::filesystem::file_size("no/such/file"); }),
              "no/such/file: No such file or directory");
    const std::string endless(5000, 'x');
    const std::string said = words_of([&] { return std::filesystem::exists(endless); });
    EXPECT_TRUE(said.ends_with(": File name too long")) << said;
    EXPECT_LT(said.size(), 300u);
}

TEST(PlainWords, OthersAreAsTheyWere) {
    EXPECT_EQ(words_of([] { throw std::runtime_error("a [json.exception] in the middle"); }),
              "a [json.exception] in the middle");
    EXPECT_EQ(words_of([] { throw std::runtime_error("[json.exception.other_error.501"); }),
              "[json.exception.other_error.501");
}

TEST(PlainWords, NobodysErrnoIsNoReason) {
    EXPECT_EQ(without_success("Failed to open x.img: Success"), "Failed to open x.img");
    EXPECT_EQ(without_success("x.img: Success story"), "x.img: Success story");
    EXPECT_EQ(without_success(""), "");
}

}  // namespace
}  // namespace hilcam
