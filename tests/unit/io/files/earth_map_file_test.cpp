// Packed maps of the Earth: what is read, and what is refused by name.

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "io/files/earth_map_file.h"
#include "render/vocabulary/check.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

std::vector<std::uint8_t> corpus(const std::string& name) {
    std::ifstream in(std::string(HILCAM_SOURCE_DIR) + "/tests/fuzz/corpus/earth_map/" + name,
                     std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

class EarthMapFile : public FilesTest {
  protected:
    std::string refusal(const std::vector<std::uint8_t>& bytes) {
        return error_of([&] { decode_earth_map(bytes, "earth.map"); });
    }
    static std::vector<std::uint8_t> with(std::vector<std::uint8_t> bytes, std::size_t at,
                                          std::uint8_t value) {
        bytes.at(at) = value;
        return bytes;
    }
};

TEST_F(EarthMapFile, TilesBecomeOneMapWithItsHalves) {
    const EarthMap map = decode_earth_map(corpus("tiles_32.map"), "earth.map");
    EXPECT_EQ(map.width(), 64);
    EXPECT_EQ(map.height(), 32);
    // 64 x 32, 32 x 16, ... 2 x 1: 4/3 of the finest less a third of a texel's.
    EXPECT_EQ(map.bytes(), (2048 + 512 + 128 + 32 + 8 + 2) * sizeof(EarthMap::Texel));
}

TEST_F(EarthMapFile, WhatIsWrongIsNamed) {
    EXPECT_THAT(refusal({}), HasSubstr("earth.map: is no map of the Earth"));
    EXPECT_THAT(refusal({'I', 'I', '*', 0, 8, 0, 0, 0}),
                HasSubstr("is a picture; accepted: what tools/make_earth_map.py"));
    EXPECT_THAT(refusal(corpus("version_9.map")), HasSubstr("has version 9; accepted: 1"));
    EXPECT_THAT(refusal(corpus("odd_size.map")), HasSubstr("is 100 x 50; accepted: twice as wide as high"));
    EXPECT_THAT(refusal(corpus("cut.map")), HasSubstr("ends within tile 0 of 2"));
    EXPECT_THAT(refusal(corpus("huge.map")), HasSubstr("which cannot hold it"));
    const std::vector<std::uint8_t> whole = corpus("one_16.map");
    EXPECT_THAT(refusal(with(whole, 24, 7)), HasSubstr("has 7 channels; accepted: 8"));
    EXPECT_THAT(refusal(with(whole, 20, 3)), HasSubstr("has tiles of 3; accepted: powers of two"));
    EXPECT_THAT(refusal(with(whole, 40, whole[40] ^ 0xff)), HasSubstr("a tile is damaged: number 0 of 2"));
    std::vector<std::uint8_t> longer = whole;
    longer.push_back(0);
    EXPECT_THAT(refusal(longer), HasSubstr("has 1 bytes after its last tile"));
    EXPECT_THAT(error_of([] { read_earth_map("/nowhere/earth.map"); }), HasSubstr("/nowhere/earth.map"));
}

}  // namespace
}  // namespace hilcam
