#include "io/naif/daf_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/vocabulary/check.h"
#include "tests/support/spice_writer.h"

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

}  // namespace
}  // namespace hilcam
