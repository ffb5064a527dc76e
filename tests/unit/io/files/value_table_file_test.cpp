#include "io/files/value_table_file.h"

#include <gmock/gmock.h>

#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ValueTableTest : public FilesTest {};

TEST_F(ValueTableTest, ReadsQuotedFieldsCommentsAndSemicolons) {
    const ValueTable t = read_value_table(
        write("t.csv", "\xEF\xBB\xBF# a comment\r\na, \"b \"\"c\"\"\" ,d\r\n\r\n1,\"[2, 3]\",\r\n"));
    EXPECT_THAT(t.columns, ElementsAre("a", "b \"c\"", "d"));
    ASSERT_EQ(t.rows.size(), 1u);
    EXPECT_THAT(t.rows[0], ElementsAre("1", "[2, 3]", ""));
    EXPECT_EQ(t.number(0, t.column("a")), 1);
    EXPECT_THAT(parse_value_table("x;y\n1,5;2\n", "t").rows[0], ElementsAre("1,5", "2"));
}

TEST_F(ValueTableTest, AMistakeIsNamedWithItsLine) {
    const auto refused = [&](const std::string& text) {
        return error_of([&] { parse_value_table(text, "t.csv"); });
    };
    EXPECT_EQ(refused("a,b\n1,2\n3\n"), "t.csv:3: found 1 fields; accepted: 2, as many as columns");
    EXPECT_EQ(refused("a,a\n1,2\n"), "t.csv:1: found 'a'; accepted: each column once");
    EXPECT_EQ(refused("a,\n1,2\n"), "t.csv:1: found ''; accepted: a name for each column");
    EXPECT_EQ(refused("a\n\"x\n"), "t.csv:2: a quoted field does not end on its line");
    EXPECT_EQ(refused("a,b\n\"x\" y,2\n"),
              "t.csv:2: found 'y,2'; accepted: the next field after a quoted one");
    EXPECT_THAT(refused("a,b\n"), HasSubstr("t.csv: found no row"));
    const ValueTable t = parse_value_table("a\nx\n", "t.csv");
    EXPECT_EQ(error_of([&] { t.number(0, 0); }), "t.csv:2: a: found 'x'; accepted: a number");
    EXPECT_EQ(error_of([&] { t.column("b"); }), "t.csv: has no column 'b'; its columns: 'a'");
}

TEST_F(ValueTableTest, AFieldComesBackAsItWasWritten) {
    for (const std::string text : {"plain", "[1, 2]", "say \"x\"", " blank ", "#1", ""}) {
        const ValueTable t = parse_value_table("a,b\n" + csv_field(text) + ",1\n", "t");
        ASSERT_EQ(t.rows.size(), 1u) << text;
        EXPECT_EQ(t.rows[0][0], text);
    }
}

}  // namespace
}  // namespace hilcam
