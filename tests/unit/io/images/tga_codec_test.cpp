// TGA: the kinds that programs write, made here by the fields of the specification.
#include <gmock/gmock.h>

#include "io/images/picture_codecs.h"
#include "io/images/picture_file.h"
#include "io/images/picture_size.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using namespace std::string_literals;
using testing::HasSubstr;
using TgaColor = std::array<std::uint8_t, 3>;

struct TgaHead {
    int note_bytes = 0, map = 0, type = 2, first_color = 0, colors = 0, color_bits = 0;
    int width = 2, height = 2, depth = 24, about = 0x20;  // 0x20: rows from the top
};
std::string tga(const TgaHead& h, const std::string& data) {
    std::string out;
    const auto add = [&](int value, int bytes) {
        for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> 8 * i);
    };
    add(h.note_bytes, 1), add(h.map, 1), add(h.type, 1), add(h.first_color, 2), add(h.colors, 2);
    add(h.color_bits, 1), add(0, 2), add(0, 2), add(h.width, 2), add(h.height, 2), add(h.depth, 1),
        add(h.about, 1);
    return out + std::string(static_cast<std::size_t>(h.note_bytes), 'n') + data;
}
std::vector<TgaColor> tga_texels(const std::string& text) {
    return decode_texture({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, "it").texels;
}

// Red, green / blue, white; stored as blue, green, red.
const std::string kRed = "\0\0\xFF"s, kGreen = "\0\xFF\0"s, kBlue = "\xFF\0\0"s, kWhite = "\xFF\xFF\xFF"s;
const std::vector<TgaColor> kPicture = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}};

TEST(TgaCodec, ColoursStandWhereTheirRowsSay) {
    EXPECT_EQ(tga_texels(tga({}, kRed + kGreen + kBlue + kWhite)), kPicture);
    EXPECT_EQ(tga_texels(tga({.note_bytes = 5}, kRed + kGreen + kBlue + kWhite)), kPicture);
    EXPECT_EQ(tga_texels(tga({.about = 0}, kBlue + kWhite + kRed + kGreen)), kPicture);     // from below
    EXPECT_EQ(tga_texels(tga({.about = 0x30}, kGreen + kRed + kWhite + kBlue)), kPicture);  // from the right
    EXPECT_EQ(tga_texels(tga({.depth = 32, .about = 0x28},
                             kRed + "\1"s + kGreen + "\2"s + kBlue + "\3"s + kWhite + "\4"s)),
              kPicture);
    // 5 bits each, blue in the lowest.
    EXPECT_EQ(tga_texels(tga({.depth = 16}, "\0\x7C\xE0\3\x1F\0\xFF\x7F"s)), kPicture);
}

TEST(TgaCodec, GreyPalettesAndRunsAreRead) {
    EXPECT_EQ(tga_texels(tga({.type = 3, .depth = 8}, "\1\2\3\4"))[2], (TgaColor{3, 3, 3}));
    EXPECT_EQ(tga_texels(tga({.type = 3, .depth = 16}, "\1\xFF\2\xFF\3\xFF\4\xFF"))[2], (TgaColor{3, 3, 3}));
    const std::string palette = kRed + kGreen + kBlue + kWhite;
    EXPECT_EQ(tga_texels(tga({.map = 1, .type = 1, .colors = 4, .color_bits = 24, .depth = 8},
                             palette + "\0\1\2\3"s)),
              kPicture);
    // A run of two reds, then two pixels as they are.
    EXPECT_EQ(tga_texels(tga({.type = 10}, "\x81"s + kRed + "\1"s + kBlue + kWhite)),
              (std::vector<TgaColor>{{255, 0, 0}, {255, 0, 0}, {0, 0, 255}, {255, 255, 255}}));
    EXPECT_EQ(tga_texels(tga({.type = 11, .depth = 8}, "\x83\7"))[3], (TgaColor{7, 7, 7}));
    EXPECT_EQ(tga_texels(tga({.map = 1, .type = 9, .colors = 4, .color_bits = 24, .depth = 8},
                             palette + "\x83\1"s))[3],
              (TgaColor{0, 255, 0}));
}

class TgaFiles : public FilesTest {
  protected:
    std::string refusal(const std::string& text) {
        const auto file = write("p.tga", text);
        return error_of([&] { read_picture(file); });
    }
};

// stb_image would give what memory holds, or black.
TEST_F(TgaFiles, WhatIsMissingIsRefused) {
    const std::string early = "p.tga: does not decode (the file ends too early)";
    EXPECT_THAT(refusal(tga({}, kRed + kGreen + kBlue)), HasSubstr(early));
    EXPECT_THAT(refusal(tga({.type = 10}, "\x82"s + kRed)), HasSubstr(early));
    EXPECT_THAT(refusal(tga({.type = 10}, "\x83\xFF"s)), HasSubstr(early));
    EXPECT_THAT(refusal(tga({.map = 1, .type = 1, .colors = 4, .color_bits = 24, .depth = 8}, kRed)),
                HasSubstr(early));
    EXPECT_THAT(refusal(tga({.about = 0x60}, kRed + kGreen + kBlue + kWhite)),
                HasSubstr("its rows are interleaved"));
    EXPECT_THAT(
        refusal(tga({.map = 1, .type = 1, .first_color = 2, .colors = 1, .color_bits = 24, .depth = 8},
                    kRed + "\2\2\2\2"s)),
        HasSubstr("its palette begins at colour 2"));
    EXPECT_THAT(refusal(tga({.width = 65535, .height = 65535}, "")), HasSubstr("65535 x 65535 pixels"));
}

// There is no mark to know one by.
TEST_F(TgaFiles, OtherBytesAreNoTga) {
    for (const std::string& text :
         {tga({.type = 4}, kRed), tga({.map = 2}, kRed), tga({.type = 1, .depth = 8}, kRed),
          tga({.depth = 12}, kRed), tga({.width = 0}, kRed), "\0\0\2"s, std::string(64, '\0'),
          std::string(64, 'x')})
        EXPECT_THAT(refusal(text), HasSubstr("p.tga: does not decode; accepted: PNG"));
}

}  // namespace
}  // namespace hilcam
