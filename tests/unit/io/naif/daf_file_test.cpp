#include "io/naif/daf_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/vocabulary/check.h"
#include "tests/support/spice_writer.h"
#include "tests/support/transfer_writer.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

std::string refusal(const std::string& bytes) {
    try {
        const DafFile file(bytes, "k.bsp");
    } catch (const InputError& error) {
        return error.what();
    }
    return "nothing";
}

SpiceWriter sixty() {
    SpiceWriter out("SPK");
    for (int i = 0; i < 60; ++i)
        out.add({"S" + std::to_string(i), double(i), i + 1.0, {i, 0, 1, 2}, {1.0 * i, 2.0 * i, 3.0 * i}});
    return out;
}

TEST(DafFile, SummariesGoOnFromRecordToRecord) {
    const DafFile file(sixty().bytes(), "k.bsp");
    ASSERT_EQ(file.arrays().size(), 60u);
    EXPECT_EQ(file.kind(), "SPK");
    EXPECT_EQ(file.arrays()[57].name, "S57");
    EXPECT_EQ(file.arrays()[57].integers[0], 57);
    EXPECT_EQ(file.words(file.arrays()[57]), (std::vector<double>{57, 114, 171}));
}

TEST(DafFile, AKernelThatIsNoneOrDamagedIsRefused) {
    const std::string whole = sixty().bytes();
    EXPECT_THAT(refusal("DAF/SPK"), HasSubstr("k.bsp: has 7 bytes; accepted: a DAF kernel"));
    EXPECT_THAT(refusal(whole.substr(0, 8000)), HasSubstr("is cut short"));
    std::string damaged = whole;
    damaged.replace(damaged.find("\r\n:\r"), 2, "\n\n");
    EXPECT_THAT(refusal(damaged), HasSubstr("damaged when it was transferred as text"));
    damaged = whole, damaged.replace(0, 8, "DAF/XYZ ");
    EXPECT_THAT(refusal(damaged), HasSubstr("found the kind 'XYZ' of kernel; accepted: SPK, CK, PCK"));
    damaged = whole, damaged.replace(88, 8, "VAX-GFLT");
    EXPECT_THAT(refusal(damaged),
                HasSubstr("found the binary format 'VAX-GFLT'; accepted: LTL-IEEE, BIG-IEEE"));
    // The second record of summaries points to the first.
    damaged = whole;
    const double first = 3;
    std::memcpy(damaged.data() + 4 * 1024, &first, sizeof first);
    EXPECT_THAT(refusal(damaged), HasSubstr("go in a circle"));
}

// --- transfer format ---

// 672.3 is 2A0.4CCCCCCCCCC (hex). The others are from a fixed-offset C-kernel of Cassini's archive: its start, by the
// kernel's comments 1.4370326715800e11 ticks, the root of one half, and an instrument's code.
TEST(TransferText, NumbersAreNaifsOwn) {
    EXPECT_EQ(transfer_double("1^1"), 1.0);
    EXPECT_EQ(transfer_double("0^0"), 0.0);
    EXPECT_EQ(transfer_double("-1^1"), -1.0);
    EXPECT_EQ(transfer_double("2A04CCCCCCCCCC^3"), 672.3);
    EXPECT_EQ(transfer_double("217561D756^A"), 143703267158.0);
    EXPECT_NEAR(transfer_double("B504F333F9DE68^0").value(), std::sqrt(0.5), 1.2e-16);
    EXPECT_EQ(transfer_double("8^-1"), 1.0 / 32);
    EXPECT_EQ(transfer_integer("-14384"), -82820);
    EXPECT_EQ(transfer_integer("-80000000"), std::numeric_limits<std::int32_t>::min());
    for (const char* word : {"", "^", "1", "1^", "^1", "G^1", "1^1.", "1^1000", "1^FFF", "+1^1", " 1^1"})
        EXPECT_FALSE(transfer_double(word)) << word;
    for (const char* word : {"", "-", "80000000", "100000000", "1.0", "x"})
        EXPECT_FALSE(transfer_integer(word)) << word;
}

// More than a block of words, numbers of all sizes.
TEST(DafFile, TheTransferFormatHoldsTheSameBits) {
    WrittenArray many{"MANY", -5e8, 5e8, {-82820, 10, 1, 2}, {}};
    for (int i = 0; i < 2500; ++i) many.words.push_back((i % 2 ? -1 : 1) * std::exp(0.2 * i - 250) / 3);
    const WrittenArray few{"FEW", 0, 1, {1, 2, 3, 4}, {0.1, 1e-308, 1.7e308}};
    const DafFile binary(SpiceWriter("CK").add(many).add(few).bytes(), "k.bc"),
        text(transfer_daf("CK", {many, few}), "k.xc");
    EXPECT_EQ(text.kind(), "CK");
    ASSERT_EQ(text.arrays().size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        const DafArray &a = binary.arrays()[i], &b = text.arrays()[i];
        EXPECT_EQ(a.name, b.name);
        EXPECT_EQ(a.doubles, b.doubles);
        EXPECT_EQ(a.integers, b.integers);
        EXPECT_EQ(binary.words(a), text.words(b));
    }
}

TEST(DafFile, ATransferFileThatIsDamagedIsNamedByItsLine) {
    const WrittenArray array{"A", 0, 1, {1, 2, 3, 4}, {1, 2, 3}};
    const std::string whole = transfer_daf("SPK", {array});
    const auto message = [&](const std::string& from, const std::string& to) {
        std::string text = whole;
        return refusal(text.replace(text.find(from), from.size(), to));
    };
    EXPECT_EQ(refusal(whole), "nothing");
    EXPECT_THAT(message("DAF/SPK ", "DAF/XYZ "), HasSubstr("k.bsp: found the kind 'XYZ' of kernel"));
    EXPECT_THAT(message("'3^1'", "'3'"), HasSubstr("k.bsp:17: found '3'; accepted: a finite double"));
    EXPECT_THAT(message("END_ARRAY 1 3", "END_ARRA 1 3"), HasSubstr("found 'END_ARRA'; accepted: END_ARRAY"));
    EXPECT_THAT(message("BEGIN_ARRAY 1 3", "BEGIN_ARRAY 1 9"),
                HasSubstr("found 'END_ARRAY'; accepted: a count"));
    EXPECT_THAT(message("BEGIN_ARRAY 1 3", "BEGIN_ARRAY 1 2"),
                HasSubstr("a block of 3 words; accepted: 1 to 2"));
    EXPECT_THAT(refusal(whole.substr(0, whole.find("TOTAL"))),
                HasSubstr("the file ends; accepted: a whole kernel"));
}

}  // namespace
}  // namespace hilcam
