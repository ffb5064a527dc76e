#include "io/files/defect_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

TEST(DefectList, ReadsWhatItWrites) {
    const std::vector<ListedDefect> made = {{DefectKind::kHot, 12, 7, 350.25},
                                            {DefectKind::kDead, 16383, 0, 0},
                                            {DefectKind::kBlinking, 3, 4, 18}};
    const std::vector<ListedDefect> read = parse_defect_list(defect_list_text(made), "list.csv");
    ASSERT_EQ(read.size(), made.size());
    for (std::size_t i = 0; i < made.size(); ++i) {
        EXPECT_EQ(read[i].kind, made[i].kind);
        EXPECT_EQ(read[i].x, made[i].x);
        EXPECT_EQ(read[i].y, made[i].y);
        EXPECT_EQ(read[i].value, made[i].value);
    }
}

TEST(DefectList, ColumnsMayBeInAnyOrder) {
    const auto read = parse_defect_list("y;x;value;kind;note\n2;1;5;hot;of 2026\n", "list.csv");
    ASSERT_EQ(read.size(), 1u);
    EXPECT_EQ(read[0].x, 1);
    EXPECT_EQ(read[0].y, 2);
}

TEST(DefectList, MistakesAreNamedWithTheirLine) {
    const auto message = [](const char* row) -> std::string {
        try {
            parse_defect_list(std::string("kind,x,y,value\nhot,1,2,3\n") + row, "list.csv");
        } catch (const InputError& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_EQ(message("warm,1,2,3\n"), "list.csv:3: found the kind 'warm'; accepted: hot, dead, blinking");
    EXPECT_EQ(message("hot,1.5,2,3\n"),
              "list.csv:3: found x '1.5'; accepted: a whole number from 0 to 16383");
    EXPECT_EQ(message("hot,1,-1,3\n"), "list.csv:3: found y '-1'; accepted: a whole number from 0 to 16383");
    EXPECT_EQ(message("hot,1,2,-3\n"), "list.csv:3: found the value '-3'; accepted: 0 to 1e9");
    EXPECT_THAT(message("hot,1,2\n"), testing::HasSubstr("list.csv:3"));
}

}  // namespace
}  // namespace hilcam
