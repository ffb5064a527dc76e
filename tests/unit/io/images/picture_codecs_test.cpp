#include "io/images/picture_codecs.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "io/images/picture_file.h"
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
              "is a picture of colours; accepted: TIFF, PNG, PGM or FITS of one channel");
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

// FITS as archives have flat fields and darks: cards of 80 letters, numbers with their most significant byte first.
class FitsNumbers : public PictureCodecs {
  protected:
    static std::string card(std::string text) {
        text.resize(80, ' ');
        return text;
    }
    static std::string block(std::string text, char fill) {
        text.resize((text.size() + 2879) / 2880 * 2880, fill);
        return text;
    }
    static std::string header(const std::vector<std::string>& cards) {
        std::string out;
        for (const std::string& one : cards) out += card(one);
        return block(out + card("END"), ' ');
    }
    static std::string big_endian(std::uint64_t word, int bytes) {
        std::string out;
        for (int i = bytes; i-- > 0;) out += static_cast<char>(word >> (8 * i) & 0xFF);
        return out;
    }
    static std::string whole(int bits, const std::vector<std::int64_t>& values) {
        std::string out;
        for (const std::int64_t value : values)
            out += big_endian(static_cast<std::uint64_t>(value), bits / 8);
        return block(out, '\0');
    }
    static std::vector<std::string> axes(int bits, int width, int height,
                                         std::vector<std::string> more = {}) {
        std::vector<std::string> out = {
            "SIMPLE  =                    T / a picture", "BITPIX  = " + std::to_string(bits), "NAXIS   = 2",
            "NAXIS1  = " + std::to_string(width), "NAXIS2  = " + std::to_string(height)};
        out.insert(out.end(), more.begin(), more.end());
        return out;
    }
    static std::vector<float> numbers(const std::string& file) {
        const PixelMap map = decode_numbers(bytes_in(file));
        return {map.all().begin(), map.all().end()};
    }
};

TEST_F(FitsNumbers, EachKindOfNumberIsRead) {
    using testing::ElementsAre;
    EXPECT_THAT(numbers(header(axes(8, 3, 1)) + whole(8, {0, 7, 255})), ElementsAre(0, 7, 255));
    EXPECT_THAT(numbers(header(axes(16, 2, 2, {"BZERO   = 32768", "BSCALE  = 1.0"})) +
                        whole(16, {-32768, 0, 5, 32767})),
                ElementsAre(0, 32768, 32773, 65535));
    EXPECT_THAT(
        numbers(header(axes(32, 2, 1, {"BSCALE  = 0.5D0 / a Fortran number"})) + whole(32, {-4, 100000})),
        ElementsAre(-2, 50000));
    EXPECT_THAT(
        numbers(header(axes(-32, 2, 1)) + block(big_endian(0x3F800000, 4) + big_endian(0xC0200000, 4), '\0')),
        ElementsAre(1, -2.5));
    EXPECT_THAT(numbers(header(axes(-64, 1, 1)) + block(big_endian(0x3FF8000000000000, 8), '\0')),
                ElementsAre(1.5));
}

// The value BLANK is no number, which a detector's map refuses with its place; rows stand as the file has them.
TEST_F(FitsNumbers, BlanksAndTheOrderOfRowsAreTaken) {
    const std::string blank = header(axes(16, 2, 2, {"BLANK   = -1"})) + whole(16, {1, 2, -1, 4});
    EXPECT_TRUE(std::isnan(numbers(blank)[2]));
    EXPECT_THAT(error_of([&] { read_pixel_map(write("blank.fits", blank), true); }),
                HasSubstr("pixel (0, 1) is nan"));
    const std::string turned = header(axes(16, 1, 3, {"ROWORDER= 'BOTTOM-UP'"})) + whole(16, {1, 2, 3});
    EXPECT_THAT(numbers(turned), testing::ElementsAre(3, 2, 1));
    EXPECT_THAT(numbers(header(axes(16, 1, 3)) + whole(16, {1, 2, 3})), testing::ElementsAre(1, 2, 3));
    const PixelMap map = read_pixel_map(write("flat.fits", turned), false);
    EXPECT_EQ(map.row(0)[0], 3);
}

// A primary header without data and a table come before the image in many archives.
TEST_F(FitsNumbers, TheFirstImageOfTwoAxesCounts) {
    const std::string empty = header({"SIMPLE  = T", "BITPIX  = 8", "NAXIS   = 0", "EXTEND  = T"});
    const std::string table = header({"XTENSION= 'BINTABLE'", "BITPIX  = 8", "NAXIS   = 2", "NAXIS1  = 4",
                                      "NAXIS2  = 3", "PCOUNT  = 10", "GCOUNT  = 1"}) +
                              block(std::string(22, 'x'), '\0');
    const std::string image = header({"XTENSION= 'IMAGE   '", "BITPIX  = 16", "NAXIS   = 3", "NAXIS1  = 2",
                                      "NAXIS2  = 1", "NAXIS3  = 1", "PCOUNT  = 0", "GCOUNT  = 1"}) +
                              whole(16, {5, 6});
    EXPECT_THAT(numbers(empty + table + image), testing::ElementsAre(5, 6));
    const std::string packed = header({"XTENSION= 'BINTABLE'", "BITPIX  = 8", "NAXIS   = 2", "NAXIS1  = 4",
                                       "NAXIS2  = 1", "PCOUNT  = 0", "GCOUNT  = 1", "ZIMAGE  = T"}) +
                               block("abcd", '\0');
    EXPECT_THAT(fault_of([&] { numbers(empty + packed); }), HasSubstr("compressed"));
    EXPECT_THAT(fault_of([&] { numbers(empty + table); }), HasSubstr("no image of two axes"));
}

TEST_F(FitsNumbers, WhatIsBrokenIsNamed) {
    const std::string whole_file = header(axes(16, 40, 40)) + whole(16, std::vector<std::int64_t>(1600, 1));
    EXPECT_THAT(fault_of([&] { numbers(whole_file.substr(0, 2880 + 3000)); }),
                HasSubstr("ends before its last row"));
    EXPECT_THAT(fault_of([&] { numbers(whole_file.substr(0, 400)); }), HasSubstr("FITS"));
    EXPECT_THAT(fault_of([&] { numbers(header(axes(12, 2, 2))); }), HasSubstr("BITPIX 12"));
    EXPECT_THAT(fault_of([&] { numbers(header(axes(16, 2, 0))); }), HasSubstr("no pixels"));
    EXPECT_THAT(fault_of([&] { numbers(header(axes(16, 1000000, 1000000))); }),
                HasSubstr("accepted: at most"));
    EXPECT_THAT(fault_of([&] {
                    numbers(header({"SIMPLE  = T", "BITPIX  = 16", "NAXIS   = 2", "NAXIS1  = two"}));
                }),
                HasSubstr("NAXIS1"));
    EXPECT_THAT(fault_of([&] {
                    numbers(header({"SIMPLE  = T", "BITPIX  = 1e300", "NAXIS   = 1", "NAXIS1  = 1e9"}));
                }),
                HasSubstr("too large"));
}

}  // namespace
}  // namespace hilcam
