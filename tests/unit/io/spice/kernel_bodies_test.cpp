#include "io/spice/kernel_bodies.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/spice/spice_kernels.h"
#include "render/vocabulary/check.h"
#include "tests/support/files.h"
#include "tests/support/spice_writer.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

// A body that stands at x [km] about a centre from start to stop (type 2, degree 1).
WrittenArray at(int body, int center, double x_km, double start, double stop, int frame = 1) {
    const double mid = 0.5 * (start + stop), radius = 0.5 * (stop - start);
    return {"B",
            start,
            stop,
            {body, center, frame, 2},
            {mid, radius, x_km, 0, 0, 0, 0, 0, start, 2 * radius, 8, 1}};
}

class KernelBodiesTest : public FilesTest {
  protected:
    void SetUp() override {
        FilesTest::SetUp();
        std::filesystem::create_directories(folder_ / "spk");
    }
    std::filesystem::path kernel(const std::string& name, std::vector<WrittenArray> arrays) {
        SpiceWriter writer("SPK", name.size() % 2 == 0);
        for (WrittenArray& a : arrays) writer.add(std::move(a));
        return write(name, writer.bytes());
    }
    std::string refusal(const std::vector<std::filesystem::path>& files) {
        return error_of([&] { SpiceKernels kernels(files); });
    }
};

TEST_F(KernelBodiesTest, BodiesMeetAtTheFirstCentreThatTheyShare) {
    const std::vector files = {
        kernel("planets.bsp", {at(4, 0, 100, 0, 100), at(499, 4, 1, 0, 100), at(10, 0, -7, 0, 100)}),
        kernel("ship.bsp", {at(-99, 10, 50, 0, 40), at(-99, 499, 3, 40, 60), at(-99, 499, 5, 70, 90)})};
    SpiceKernels k(files);
    k.bodies.require(-99, "test"), k.bodies.require(10, "test");
    StateVector s;
    ASSERT_TRUE(k.bodies.state(-99, 499, 50, s));
    EXPECT_NEAR(s.position_m.x, 3000, 1e-9);
    ASSERT_TRUE(k.bodies.state(-99, 10, 50, s));
    EXPECT_NEAR(s.position_m.x, 111000, 1e-9);
    ASSERT_TRUE(k.bodies.state(10, -99, 20, s));
    EXPECT_NEAR(s.position_m.x, -50000, 1e-9);
    // At a shared instant the segment that was loaded later counts.
    ASSERT_TRUE(k.bodies.state(-99, 0, 40, s));
    EXPECT_NEAR(s.position_m.x, 104000, 1e-9);
    EXPECT_FALSE(k.bodies.state(-99, 499, 65, s));
    const auto spans = k.bodies.coverage(-99, 499);
    ASSERT_EQ(spans.size(), 2u);
    EXPECT_EQ(spans[0].start_s, 0);
    EXPECT_EQ(spans[0].stop_s, 60);
    EXPECT_EQ(spans[1].start_s, 70);
    EXPECT_EQ(spans[1].stop_s, 90);
    EXPECT_THROW(k.bodies.require(-98, "test"), InputError);
}

TEST_F(KernelBodiesTest, LaterKernelsGoBeforeEarlierOnesAndFramesAreTurned) {
    const auto first = kernel("first.bsp", {at(-99, 10, 1, 0, 100)}),
               second = kernel("second.bsp", {at(-99, 10, 2, 50, 100, 17)});
    SpiceKernels k(std::vector{first, second});
    k.bodies.require(-99, "test");
    StateVector s;
    ASSERT_TRUE(k.bodies.state(-99, 10, 20, s));
    EXPECT_NEAR(s.position_m.x, 1000, 1e-9);
    ASSERT_TRUE(k.bodies.state(-99, 10, 60, s));
    EXPECT_NEAR(s.position_m.x, 2000, 1e-9);  // the x axes of ecliptic and equator are one
    SpiceKernels other(std::vector{second, first});
    other.bodies.require(-99, "test");
    ASSERT_TRUE(other.bodies.state(-99, 10, 60, s));
    EXPECT_NEAR(s.position_m.x, 1000, 1e-9);
}

TEST_F(KernelBodiesTest, AMetaKernelNamesKernelsBesideIt) {
    kernel("spk/long_name.bsp", {at(-99, 10, 1, 0, 100)});
    write("names.tf", "KPL/FK\n\\begindata\nNAIF_BODY_NAME += 'SHIP'\nNAIF_BODY_CODE += -99\n");
    const auto meta = write("all.tm",
                            "KPL/MK\n\\begindata\nPATH_SYMBOLS = ( 'K' )\nPATH_VALUES = ( 'spk' )\n"
                            "KERNELS_TO_LOAD = ( 'names.tf' '$K/long_+'\n 'name.bsp' 'shape.bds' )\n");
    // A shape is an object's mesh: it is passed over here.
    write("shape.bds", "DAS/DSK " + std::string(1100, '\0'));
    SpiceKernels k(std::vector{meta});
    EXPECT_EQ(k.set.files.size(), 4u);
    EXPECT_NO_THROW(k.bodies.require(-99, "test"));
    EXPECT_EQ(k.set.pool.texts("NAIF_BODY_NAME")->front(), "SHIP");
}

TEST_F(KernelBodiesTest, KernelsThatCannotBeReadAreNamed) {
    const auto bad = [&](const std::string& list) {
        return refusal(
            {write("bad.tm", "\\begindata\nPATH_SYMBOLS = 'A'\nPATH_VALUES = 'x'\nKERNELS_TO_LOAD = ( " +
                                 list + " )\n")});
    };
    EXPECT_THAT(bad("'missing.bsp'"), HasSubstr("bad.tm:4: KERNELS_TO_LOAD: no such file"));
    EXPECT_THAT(bad("'$B/k.bsp'"), HasSubstr("whose symbol has no path"));
    EXPECT_THAT(bad("'bad.tm'"), HasSubstr("more than 8 deep"));
    EXPECT_THAT(refusal({write("x.xsp", "DAFETF NAIF DAF ENCODED TRANSFER FILE\n")}),
                HasSubstr("transfer format"));
    EXPECT_THAT(refusal({write("x.bds", "DAS/DSK " + std::string(1100, '\0'))}),
                HasSubstr("is a shape kernel (DSK)"));
    EXPECT_THAT(refusal({folder_ / "nothing.bsp"}), HasSubstr("no such file"));
    const std::string whole = SpiceWriter("SPK").add(at(-99, 10, 1, 0, 1)).bytes();
    EXPECT_THAT(refusal({write("cut.bsp", whole.substr(0, 4096))}),
                HasSubstr("cut.bsp: array 1 ('B'): ends at word 524, and the file has 512: it is cut short"));
}

}  // namespace
}  // namespace hilcam
