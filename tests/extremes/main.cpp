// One test for each table of extremes.csv. With --table the program writes that file instead.

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iostream>
#include <sstream>

#include "tests/extremes/groups.h"
#include "tests/extremes/table.h"

namespace hilcam::extremes {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

std::vector<Measured> measure(const Group& group) {
    std::vector<Measured> out;
    for (const Case& row : group.cases) out.push_back(kSanitized && row.heavy ? Measured{} : row.measure());
    return out;
}

std::string committed_file() {
    std::ifstream file(HILCAM_SOURCE_DIR "/tests/extremes/extremes.csv");
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

class Extremes : public testing::TestWithParam<Group> {};

TEST_P(Extremes, KeepToTheirLimits) {
    const Group& group = GetParam();
    const std::vector<Measured> measured = measure(group);
    for (std::size_t i = 0; i < group.cases.size(); ++i) {
        const Case& row = group.cases[i];
        ASSERT_EQ(row.limits.size(), group.quantities.size());
        if (measured[i].empty()) continue;
        ASSERT_EQ(measured[i].size(), row.limits.size());
        for (std::size_t q = 0; q < row.limits.size(); ++q) {
            EXPECT_TRUE(std::isfinite(measured[i][q].error)) << row.value << ", " << group.quantities[q];
            EXPECT_LE(measured[i][q].error, row.limits[q]) << row.value << ", " << group.quantities[q];
        }
    }
    for (const std::string& difference : differences(committed_file(), group, measured))
        ADD_FAILURE() << "tests/extremes/extremes.csv, " << group.title << ": " << difference;
}

INSTANTIATE_TEST_SUITE_P(All, Extremes, testing::ValuesIn(all_groups()),
                         [](const auto& tested) { return tested.param.name; });

TEST(ExtremesFile, HasTheSuitesTables) {
    std::vector<std::string> titles;
    for (const Group& group : all_groups()) titles.push_back(group.title);
    EXPECT_EQ(titles_in(committed_file()), titles);
}

}  // namespace

// Instead of its bytes.
void PrintTo(const Group& group, std::ostream* out) { *out << group.title; }

}  // namespace hilcam::extremes

int main(int argc, char** argv) {
    using namespace hilcam::extremes;
    if (argc == 2 && std::strcmp(argv[1], "--table") == 0) {
        std::cout << head_line();
        for (const Group& group : all_groups()) std::cout << lines_of(group, measure(group)) << std::flush;
        return 0;
    }
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
