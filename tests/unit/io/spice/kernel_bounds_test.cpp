// Kernels that would take more time or memory than a set of a mission does are refused in one line.

#include <gmock/gmock.h>

#include <cstring>

#include "io/spice/spice_kernels.h"
#include "io/spice/text_kernel.h"
#include "tests/support/files.h"
#include "tests/support/spice_writer.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

class KernelBounds : public FilesTest {
  protected:
    std::string refusal(const std::filesystem::path& file) {
        return error_of([&] { load_kernels(std::vector{file}); });
    }
    std::filesystem::path meta(const std::string& name, const std::string& names) {
        return write(name, "KPL/MK\n\\begindata\nKERNELS_TO_LOAD = ( " + names + " )\n");
    }
    // A body that stands so many km along x.
    std::filesystem::path standing(const std::string& name, double x_km) {
        return write(name, SpiceWriter("SPK")
                               .add({"B", 0, 100, {-99, 10, 1, 2}, {50, 50, x_km, 0, 0, 0, 100, 5, 1}})
                               .bytes());
    }
};

// Twenty names in each of seven files, each of the next: 20^7 of them.
TEST_F(KernelBounds, MetaKernelsThatNameEachOtherManyTimesOverAreRefused) {
    write("7.tf", "KPL/FK\n\\begindata\nA = 1\n");
    for (int i = 6; i >= 0; --i) {
        std::string names;
        for (int k = 0; k < 20; ++k) names += "'" + std::to_string(i + 1) + ".tf' ";
        meta(std::to_string(i) + ".tf", names);
    }
    EXPECT_THAT(refusal(folder_ / "0.tf"), HasSubstr("name each other's files more than 10000 times"));
}

TEST_F(KernelBounds, AFileThatIsNamedAgainIsReadOnceAndCountsWhereItIsNamedLast) {
    const auto one = write("one.tf", "KPL/FK\n\\begindata\nA += 1\nB = 1\n");
    const auto two = write("two.tf", "KPL/FK\n\\begindata\nA += 2\nB = 2\n");
    const KernelSet set = load_kernels(std::vector{one, two, meta("all.tm", "'two.tf' 'one.tf'")});
    EXPECT_EQ(set.pool.number("B"), 1);
    EXPECT_THAT(*set.pool.numbers("A"), testing::ElementsAre(2, 1));

    const auto near = standing("near.bsp", 1), far = standing("far.bsp", 2);
    SpiceKernels kernels(std::vector{near, far, near});
    EXPECT_EQ(kernels.set.binaries.size(), 2u);
    kernels.bodies.require(-99, "test");
    StateVector s;
    ASSERT_TRUE(kernels.bodies.state(-99, 10, 50, s));
    EXPECT_EQ(s.position_m.x, 1000);
}

// A name of 20 000 pieces is no file of Linux, whose names end at 4096 bytes.
TEST_F(KernelBounds, ANameOfManyPiecesIsRefusedInOneShortLine) {
    std::string pieces;
    for (int i = 0; i < 20'000; ++i) pieces += "'a+'\n";
    const std::string told = refusal(meta("long.tm", pieces + "'b'"));
    EXPECT_THAT(told, HasSubstr("long.tm:3: KERNELS_TO_LOAD: found the name 'aaa"));
    EXPECT_THAT(told, HasSubstr("of more than 4096 bytes"));
    EXPECT_LT(told.size(), folder_.string().size() + 250);
    // The same by a path that is long; a piece of a name that is too long for the file system.
    write("path.tm", "KPL/MK\n\\begindata\nPATH_SYMBOLS = 'A'\nPATH_VALUES = '" + std::string(5000, 'x') +
                         "'\nKERNELS_TO_LOAD = '$A'\n");
    EXPECT_THAT(refusal(folder_ / "path.tm"), HasSubstr("of more than 4096 bytes"));
    EXPECT_THAT(refusal(meta("piece.tm", "'" + std::string(1000, 'x') + "'")),
                HasSubstr("KERNELS_TO_LOAD: no such file"));
}

TEST_F(KernelBounds, AMetaKernelHasOnlySoManyNamesAndSymbols) {
    write("a.tf", "KPL/FK\n\\begindata\nA = 1\n");
    std::string names, symbols, values;
    for (int i = 0; i < 10'001; ++i) names += "'a.tf'\n";
    EXPECT_THAT(refusal(meta("many.tm", names)), HasSubstr("has more than 10000 names"));
    for (int i = 0; i < 1001; ++i) symbols += "'S" + std::to_string(i) + "' ", values += "'x' ";
    write("symbols.tm", "KPL/MK\n\\begindata\nPATH_SYMBOLS = ( " + symbols + ")\nPATH_VALUES = ( " + values +
                            ")\nKERNELS_TO_LOAD = 'a.tf'\n");
    EXPECT_THAT(refusal(folder_ / "symbols.tm"), HasSubstr("has 1001 PATH_SYMBOLS"));
}

// Two summaries name all words of the file: read, they would be twice the file, and 20 000 of them 20 000 times.
TEST_F(KernelBounds, ArraysThatShareWordsAreRefused) {
    std::string bytes = SpiceWriter("SPK")
                            .add({"A", 0, 1, {-99, 10, 1, 2}, std::vector<double>(128, 1)})
                            .add({"B", 0, 1, {-99, 10, 1, 2}, std::vector<double>(128, 1)})
                            .bytes();
    EXPECT_NO_THROW(DafFile(bytes, "k.bsp"));
    const auto words = static_cast<std::int32_t>(bytes.size() / 8);
    constexpr std::size_t kSummaries = 2 * 1024 + 24, kSummary = 40, kAddresses = 2 * 8 + 4 * 4;
    for (const std::size_t i : {0u, 1u}) {
        const std::int32_t first = 1, last = words - static_cast<std::int32_t>(i);
        std::memcpy(bytes.data() + kSummaries + i * kSummary + kAddresses, &first, 4);
        std::memcpy(bytes.data() + kSummaries + i * kSummary + kAddresses + 4, &last, 4);
    }
    EXPECT_THAT(error_of([&] { DafFile(bytes, "k.bsp"); }),
                HasSubstr("k.bsp: its first 2 arrays have 1535 words, and the file 768: they overlap"));
}

TEST_F(KernelBounds, TextKernelsHoldOnlySoManyNames) {
    std::string text = "\\begindata\n";
    for (int i = 0; i <= 300'000; ++i) text += "A" + std::to_string(i) + "=1\n";
    KernelPool pool;
    const std::string told = error_of([&] { read_text_kernel(text, "many.tf", pool); });
    EXPECT_THAT(told, HasSubstr("many.tf:300002: 'A300000' is more than the kernels' variables may hold"));
    EXPECT_THAT(told, HasSubstr("accepted: 300000 names, 10000000 numbers and 2000000 texts at most"));
}

// What is replaced makes room.
TEST_F(KernelBounds, TextKernelsHoldOnlySoManyValues) {
    KernelPool pool;
    const auto assign = [&](const std::string& name, std::size_t numbers, std::size_t texts, bool append) {
        pool.assign(name, {std::vector<double>(numbers), std::vector<std::string>(texts), "k.tf:3"}, append);
    };
    assign("A", 6'000'000, 0, false);
    assign("A", 6'000'000, 0, false);
    EXPECT_THAT(error_of([&] { assign("A", 6'000'000, 0, true); }), HasSubstr("k.tf:3: 'A' is more than"));
    assign("T", 0, 1'500'000, false);
    EXPECT_THAT(error_of([&] { assign("U", 0, 600'000, false); }), HasSubstr("k.tf:3: 'U' is more than"));
}

}  // namespace
}  // namespace hilcam
