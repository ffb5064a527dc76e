#include "io/config/second_document.h"

#include <gtest/gtest.h>

namespace hilcam {
namespace {

TEST(SecondDocument, BeginsAtAMarkerBetweenContents) {
    EXPECT_EQ(line_of_second_document("a: 1\n---\nb: 2\n"), 2u);
    EXPECT_EQ(line_of_second_document("# note\n---\na: 1\n--- # more\r\nb: 2"), 4u);
    EXPECT_EQ(line_of_second_document("a: 1\n...\n\nb: 2\n"), 2u);
    EXPECT_EQ(line_of_second_document("a: 1\n--- {b: 2}"), 2u);
}

TEST(SecondDocument, IsNotThereWhereOneDocumentIs) {
    for (const char* const one :
         {"", "a: 1", "---\na: 1\n...\n", "%YAML 1.2\n---\na: 1\n---\n# nothing more\n",
          "a: |\n  ---\n  text\n", "a: 1\n----\n", "\n\n---\n\n---\na: 1\n"})
        EXPECT_EQ(line_of_second_document(one), std::nullopt) << one;
}

// Of such a text yaml-cpp makes empty documents without end.
TEST(SecondDocument, IsFoundWhereAFirstOneIsBroken) {
    EXPECT_EQ(line_of_second_document(", `]\nb: (a\n---\nsecond: document\n"), 3u);
}

}  // namespace
}  // namespace hilcam
