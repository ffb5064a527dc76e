#include "io/pictures/picture_codecs.h"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "io/pictures/picture_file.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

using Color = std::array<std::uint8_t, 3>;

// Pictures of 13 x 7 px that other programs wrote (Pillow 9.4, Netpbm 11.1, tiles.tiff by hand): red 19 x,
// green 36 y, blue 12 (x + y); numbers 300 x + 5000 y.
std::string seed(const std::string& name) {
    std::ifstream in(HILCAM_SOURCE_DIR "/tests/fuzz/corpus/picture/" + name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
PictureBytes bytes_in(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

class PictureCodecs : public FilesTest {
  protected:
    Texture texture_of(const std::string& name) { return decode_texture(bytes_in(seed(name)), name); }
    // What is said of the beginning of a picture, of so many bytes, as a file of the same ending.
    std::string refusal(const std::string& name, std::size_t bytes) {
        const auto file = write("cut_" + name, seed(name).substr(0, bytes));
        return error_of([&] { read_picture(file); });
    }
    template <class F>
    static std::string fault_of(F&& f) {
        try {
            f();
        } catch (const PictureFault& fault) {
            return fault.what();
        }
        return "no fault";
    }
};

TEST_F(PictureCodecs, LosslessKindsGiveTheColoursThatWereWritten) {
    for (const char* name : {"color.png", "interlaced.png", "color.bmp", "alpha.webp", "color.ppm",
                             "color_text.ppm", "color.tga"}) {
        const Texture texture = texture_of(name);
        ASSERT_EQ(texture.width, 13) << name;
        ASSERT_EQ(texture.height, 7) << name;
        for (std::size_t y = 0; y < 7; ++y)
            for (std::size_t x = 0; x < 13; ++x) {
                // A lossless WebP may change what an alpha of 0 hides: its first column.
                if (std::string(name) == "alpha.webp" && x == 0) continue;
                const Color expected = {static_cast<std::uint8_t>(19 * x), static_cast<std::uint8_t>(36 * y),
                                        static_cast<std::uint8_t>(12 * (x + y))};
                ASSERT_EQ(texture.texels[y * 13 + x], expected) << name << " " << x << " " << y;
            }
    }
}

// JPEG at quality 80 and lossy WebP halve the colours' resolution: what Pillow itself reads from them is as
// far off.
TEST_F(PictureCodecs, LossyKindsGiveThemNearly) {
    for (const char* name : {"color.jpg", "color.webp", "jpeg.tiff", "palette.png", "palette.bmp"}) {
        const Texture texture = texture_of(name);
        double sum = 0;
        for (std::size_t y = 0; y < 7; ++y)
            for (std::size_t x = 0; x < 13; ++x)
                sum += std::abs(texture.texels[y * 13 + x][0] - 19.0 * static_cast<double>(x));
        EXPECT_LT(sum / 91, std::string(name) == "palette.bmp" ? 60 : 20) << name;
    }
    const Color grey = texture_of("progressive.jpg").texels[90];
    EXPECT_EQ(grey[0], grey[1]);
    EXPECT_EQ(grey[0], grey[2]);
}

TEST_F(PictureCodecs, NumbersAreThoseOfTheFile) {
    const auto expect = [](const PixelMap& map, auto value) {
        ASSERT_EQ(map.width(), 13);
        ASSERT_EQ(map.height(), 7);
        for (int y = 0; y < 7; ++y)
            for (int x = 0; x < 13; ++x)
                ASSERT_EQ(map.row(y)[static_cast<std::size_t>(x)], static_cast<float>(value(x, y)));
    };
    const auto number = [](int x, int y) { return 300 * x + 5000 * y; };
    expect(decode_png_numbers(bytes_in(seed("grey16.png"))), number);
    expect(decode_tiff_numbers(bytes_in(seed("grey16.tiff"))), number);
    expect(decode_tiff_numbers(bytes_in(seed("float.tiff"))),
           [&](int x, int y) { return static_cast<float>(number(x, y) / 7.0); });
    expect(decode_tiff_numbers(bytes_in(seed("tiles.tiff"))), [](int x, int y) { return 10 * x + y; });
}

TEST_F(PictureCodecs, WhatIsNoMapOfNumbersIsRefusedByWhatItIs) {
    EXPECT_EQ(fault_of([] { decode_numbers(bytes_in(seed("color.png"))); }), "has 3 channels; accepted: one");
    EXPECT_EQ(fault_of([] { decode_numbers(bytes_in(seed("palette.png"))); }),
              "has a palette of colours; accepted: one channel");
    EXPECT_EQ(fault_of([] { decode_numbers(bytes_in(seed("jpeg.tiff"))); }), "has 3 channels; accepted: one");
    EXPECT_EQ(fault_of([] { decode_numbers(bytes_in(seed("color.jpg"))); }),
              "is a picture of colours; accepted: TIFF, PNG or PGM of one channel");
}

TEST_F(PictureCodecs, ACutPictureIsRefusedInTheWordsOfItsLibraryAndNothingIsPrinted) {
    testing::internal::CaptureStderr();
    const auto most = [](const std::string& name) { return seed(name).size(); };
    EXPECT_THAT(refusal("color.png", most("color.png") - 30), HasSubstr("does not decode (libpng: "));
    EXPECT_THAT(refusal("color.jpg", most("color.jpg") - 6),
                HasSubstr("does not decode (libjpeg: Premature end of JPEG file)"));
    EXPECT_THAT(refusal("grey16.tiff", most("grey16.tiff") / 3), HasSubstr("does not decode"));
    EXPECT_THAT(refusal("color.webp", most("color.webp") - 20),
                HasSubstr("does not decode (libwebp: the file ends too early)"));
    EXPECT_THAT(refusal("color.bmp", 40), HasSubstr("does not decode (stb_image: "));
    EXPECT_THAT(
        refusal("print.jpg", most("print.jpg")),
        HasSubstr("print.jpg: is a JPEG for printing (CMYK); accepted: grey, or red, green and blue"));
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// 16-bit numbers in both kinds, colours in both.
TEST_F(PictureCodecs, WhatIsWrittenIsReadAgain) {
    const std::vector<std::uint16_t> numbers = {0, 1, 4095, 65535, 256, 77};
    const PictureSamples grey{
        {reinterpret_cast<const std::uint8_t*>(numbers.data()), 12}, 3, 2, SampleKind::kGray16};
    for (const PixelMap& map :
         {decode_png_numbers(bytes_in(encode_png(grey))), decode_tiff_numbers(bytes_in(encode_tiff(grey)))})
        for (std::size_t i = 0; i < numbers.size(); ++i)
            EXPECT_EQ(map.all()[i], static_cast<float>(numbers[i]));
    const std::vector<std::uint8_t> colors = {1, 2, 3, 250, 100, 0};
    const PictureSamples color{colors, 2, 1, SampleKind::kRgb8};
    for (const Texture& texture :
         {decode_png(bytes_in(encode_png(color))), decode_tiff(bytes_in(encode_tiff(color)))})
        EXPECT_EQ(texture.texels, (std::vector<Color>{{1, 2, 3}, {250, 100, 0}}));
}

TEST_F(PictureCodecs, NotesStandInThePicture) {
    const std::vector<std::uint8_t> grey = {7};
    const PictureSamples picture{grey, 1, 1, SampleKind::kGray8};
    const std::string png = encode_png(picture, {{{"seed", "12"}, {"name", "\xC3\x84ther"}}, 2.2});
    EXPECT_THAT(png, HasSubstr(std::string("tEXtseed\0"
                                           "12",
                                           11)));
    EXPECT_THAT(png, HasSubstr(std::string("iTXtname\0\0\0\0\0\xC3\x84ther", 19)));
    EXPECT_THAT(png, HasSubstr(std::string("gAMA\0\0\xB1\x8F", 8)));  // 45455 of 100000
    const std::string tiff = encode_tiff(picture, {"what", "who", "which", "2026:03:20 06:00:00"});
    for (const char* text : {"what", "who", "which", "2026:03:20 06:00:00"})
        EXPECT_THAT(tiff, HasSubstr(text));
    EXPECT_EQ(png, encode_png(picture, {{{"seed", "12"}, {"name", "\xC3\x84ther"}}, 2.2}));
}

}  // namespace
}  // namespace hilcam
