// PGM and PPM by their specification: bytes and words, comments, any white up to 65535.
#include <gmock/gmock.h>

#include "io/images/picture_codecs.h"
#include "io/images/picture_file.h"
#include "io/images/picture_size.h"
#include "io/images/pnm_header.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using namespace std::string_literals;
using testing::HasSubstr;
using PnmColor = std::array<std::uint8_t, 3>;

PictureBytes pnm_bytes(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}
Texture pnm_texture(const std::string& text) { return decode_texture(pnm_bytes(text), "it"); }

TEST(PnmCodec, BytesAndWordsAreTheSamePicture) {
    const PnmColor red = {255, 0, 0}, grey = {1, 2, 3};
    for (const std::string& text :
         {"P6 2 1 255\n\xFF\0\0\1\2\3"s, "P6\n# made by hand\n2 # wide\n1\n255\n\xFF\0\0\1\2\3"s,
          "P3\n2 1\n255\n255 0 0  1 2\n3\n"s, "P3 2 1 255 255 0 0 1 2 3"s}) {
        const Texture t = pnm_texture(text);
        ASSERT_EQ(t.width, 2);
        ASSERT_EQ(t.height, 1);
        EXPECT_EQ(t.texels[0], red);
        EXPECT_EQ(t.texels[1], grey);
    }
    EXPECT_EQ(pnm_texture("P5 1 2 255\n\7\x0A"s).texels[1], (PnmColor{10, 10, 10}));
    EXPECT_EQ(pnm_texture("P2 1 2 255 7 9").texels[1], (PnmColor{9, 9, 9}));
}

// The sample that is white becomes 255: of 4 bits, of 10 and of 16, each rounded.
TEST(PnmCodec, WhiteIsWhatTheHeadSays) {
    EXPECT_EQ(pnm_texture("P2 3 1 15 0 7 15").texels[1][0], 119);            // 7 * 255 / 15
    EXPECT_EQ(pnm_texture("P5 2 1 1023\n\1\xFF\3\xFF"s).texels[0][0], 127);  // 511 * 255 / 1023 = 127.4
    EXPECT_EQ(pnm_texture("P5 2 1 1023\n\1\xFF\3\xFF"s).texels[1][0], 255);
    EXPECT_EQ(pnm_texture("P6 1 1 65535\n\xFF\xFF\x80\0\0\xFF"s).texels[0], (PnmColor{255, 128, 1}));
}

TEST(PnmCodec, NumbersAreThoseOfTheFile) {
    const PixelMap wide = decode_numbers(pnm_bytes("P5 2 1 4095\n\x0F\xFF\0\x10"s));
    EXPECT_EQ(wide.row(0)[0], 4095);
    EXPECT_EQ(wide.row(0)[1], 16);
    EXPECT_EQ(decode_numbers(pnm_bytes("P2 1 1 65535 40000")).row(0)[0], 40000);
    EXPECT_THROW(decode_numbers(pnm_bytes("P3 1 1 255 1 2 3")), PictureFault);
}

class PnmFiles : public FilesTest {
  protected:
    std::string refusal(const std::string& text) {
        const auto file = write("p.ppm", text);
        return error_of([&] { read_picture(file); });
    }
};

TEST_F(PnmFiles, MistakesAreNamed) {
    EXPECT_THAT(refusal("P6 2 1 255\n\1\2\3\4\5"),
                HasSubstr("p.ppm: does not decode (the file ends too early)"));
    EXPECT_THAT(refusal("P3 2 1 255\n1 2 3 4 5"), HasSubstr("the file ends too early"));
    EXPECT_THAT(refusal("P3 1 1 255\n1 2 x 4 5 6"), HasSubstr("a sample is no number"));
    EXPECT_THAT(refusal("P2 1 1 15 16"), HasSubstr("a sample is 16, and its head says that 15 is white"));
    EXPECT_THAT(refusal("P6 100000 100000 255\n"), HasSubstr("100000 x 100000 pixels"));
    for (const char* text : {"P6", "P6 2", "P6 2 1 0\n123456", "P6 2 1 65536\n123456", "P4 8 1\n\1",
                             "P6x2 1 255\n123456", "P6 99999999999 1 255\n"})
        EXPECT_THAT(refusal(text),
                    HasSubstr("does not decode; accepted: PNG, JPEG, TIFF, BMP, WebP, PPM, PGM, TGA"))
            << text;
    EXPECT_FALSE(pnm_header(pnm_bytes("P6 2 1 255")));  // no blank ends the head
}

}  // namespace
}  // namespace hilcam
