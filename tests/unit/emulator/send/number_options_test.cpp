#include "emulator/send/number_options.h"

#include <gmock/gmock.h>

#include <array>
#include <cstdint>
#include <vector>

namespace hilcam {
namespace {

using testing::HasSubstr;

struct Numbers {
    std::uint64_t frames = 0;
    std::uint16_t port = 0;
    std::int64_t offset = 0;
    double duration_s = 0;
    std::array<double, 3> place{};
    std::string name;
};

// Gives what is wrong with the words, or nothing.
std::string problem(const std::vector<std::string>& words, Numbers* out = nullptr) {
    Numbers numbers;
    CLI::App app;
    app.require_subcommand(1);
    CLI::App* command = app.add_subcommand("run");
    command->add_option("--frames", numbers.frames);
    command->add_option("--port", numbers.port)->check(CLI::Range(1, 65535));
    command->add_option("--offset", numbers.offset);
    command->add_option("--duration", numbers.duration_s)->check(CLI::Range(0.0, 1e9));
    command->add_option("--place", numbers.place);
    command->add_option("--name", numbers.name);
    read_numbers_strictly(app);
    std::vector<std::string> reversed = {"run"};
    reversed.insert(reversed.begin(), words.rbegin(), words.rend());
    try {
        app.parse(reversed);
    } catch (const CLI::ParseError& error) {
        return error.what();
    }
    if (out) *out = numbers;
    return {};
}

TEST(NumberOptions, WhatIsNoNumberOfItsKindIsRefused) {
    for (const char* text :
         {"-1", "99999999999999999999", "-18446744073709551615", "0x10", "1.5", "1e3", "ten", "-0"})
        EXPECT_EQ(problem({"--frames=" + std::string(text)}),
                  "--frames: found '" + std::string(text) + "'; accepted: a whole number, 0 or more");
    for (const char* text : {"nan", "inf", "1e999", "1,5", "2s"}) {
        EXPECT_EQ(problem({"--duration=" + std::string(text)}),
                  "--duration: found '" + std::string(text) + "'; accepted: a number");
        EXPECT_EQ(problem({"--place", "1", "2", text}),
                  "--place: found '" + std::string(text) + "'; accepted: a number");
    }
    EXPECT_EQ(problem({"--duration=-inf"}), "--duration: found '-inf'; accepted: a number");
    EXPECT_EQ(problem({"--offset=99999999999999999999"}),
              "--offset: found '99999999999999999999'; accepted: a whole number");
    EXPECT_EQ(problem({"--port=-65535"}), "--port: found '-65535'; accepted: a whole number, 0 or more");
    EXPECT_THAT(problem({"--port=65536"}), HasSubstr("--port"));  // by its own range
}

TEST(NumberOptions, NumbersAreWhatIsWritten) {
    Numbers n;
    ASSERT_EQ(problem({"--frames=0010", "--port=08", "--offset=-012", "--duration=1e-3", "--place", "-1",
                       "2.5", "3e2", "--name=-7x"},
                      &n),
              "");
    EXPECT_EQ(n.frames, 10u);
    EXPECT_EQ(n.port, 8u);
    EXPECT_EQ(n.offset, -12);
    EXPECT_EQ(n.duration_s, 1e-3);
    EXPECT_EQ(n.place, (std::array<double, 3>{-1, 2.5, 300}));
    EXPECT_EQ(n.name, "-7x");
    ASSERT_EQ(problem({"--frames=18446744073709551615"}, &n), "");
    EXPECT_EQ(n.frames, std::uint64_t{18446744073709551615u});
}

}  // namespace
}  // namespace hilcam
