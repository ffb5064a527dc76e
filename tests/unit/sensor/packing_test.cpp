#include "sensor/packing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace hilcam {
namespace {

using testing::ElementsAre;

std::vector<std::uint8_t> packed(std::vector<std::uint16_t> dn, const PixelLayout& layout) {
    std::vector<std::uint8_t> out(packed_bytes(dn.size(), layout));
    pack(dn, layout, out);
    return out;
}

TEST(Packing, PlainPixelsAreLittleEndian) {
    EXPECT_THAT(packed({0x123, 0xFFF}, {Packing::kNone, 12, 16}), ElementsAre(0x23, 0x01, 0xFF, 0x0F));
    EXPECT_THAT(packed({0x12, 0xFF}, {Packing::kNone, 8, 8}), ElementsAre(0x12, 0xFF));
}

// PFNC, Mono12p: p0[7:0], p1[3:0] p0[11:8], p1[11:4]. Mono10p: p0[7:0], p1[5:0] p0[9:8], p2[3:0] p1[9:6], ...
TEST(Packing, PfncIsABitStream) {
    EXPECT_THAT(packed({0xABC, 0x123}, {Packing::kPfnc, 12, 16}), ElementsAre(0xBC, 0x3A, 0x12));
    EXPECT_THAT(packed({0x3FF, 0, 0x3FF, 0}, {Packing::kPfnc, 10, 16}),
                ElementsAre(0xFF, 0x03, 0xF0, 0x3F, 0x00));
    EXPECT_THAT(packed({0xABC}, {Packing::kPfnc, 12, 16}), ElementsAre(0xBC, 0x0A));
    EXPECT_THAT(packed({0x3FFF, 0}, {Packing::kPfnc, 14, 16}), ElementsAre(0xFF, 0x3F, 0x00, 0x00));
}

// GigE Vision: p0[11:4], p1[3:0] p0[3:0], p1[11:4]; of ten bits p0[9:2], 00 p1[1:0] 00 p0[1:0], p1[9:2].
TEST(Packing, GigeIsPairsInThreeBytes) {
    EXPECT_THAT(packed({0xABC, 0x123}, {Packing::kGige, 12, 16}), ElementsAre(0xAB, 0x3C, 0x12));
    EXPECT_THAT(packed({0x3FD, 0x002}, {Packing::kGige, 10, 16}), ElementsAre(0xFF, 0x21, 0x00));
    EXPECT_THAT(packed({0xABC}, {Packing::kGige, 12, 16}), ElementsAre(0xAB, 0x0C));
}

}  // namespace
}  // namespace hilcam
