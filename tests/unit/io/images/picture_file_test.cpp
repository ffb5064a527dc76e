#include "io/images/picture_file.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <iostream>
#include <iterator>

#include "io/images/image_file.h"
#include "io/images/picture_size.h"
#include "tests/support/files.h"
#include "tests/support/limits.h"

namespace hilcam {
namespace {

using testing::HasSubstr;
using namespace std::string_literals;

std::string size_of(const std::string& bytes) {
    const auto size = picture_size({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    return size ? std::to_string(size->width) + " x " + std::to_string(size->height) : "none";
}

// Signature and header chunk of an 8-bit grey picture, then one byte that is no data.
std::string png_header(std::uint32_t width, std::uint32_t height) {
    std::string out = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR"s;
    for (const std::uint32_t v : {width, height})
        for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(v >> shift);
    return out + "\x08\0\0\0\0"s;
}

TEST(PictureSize, IsReadFromTheHeaderOfEachKind) {
    EXPECT_EQ(size_of(png_header(70000, 3)), "70000 x 3");
    // A quantisation table, a fill byte, then a progressive frame.
    EXPECT_EQ(size_of("\xFF\xD8\xFF\xDB\0\x04\0\0\xFF\xFF\xC2\0\x0B\x08\x01\x00\x02\x00\x01"s), "512 x 256");
    EXPECT_EQ(size_of("BM"s + std::string(12, '\0') + "\x28\0\0\0\x05\0\0\0\xFD\xFF\xFF\xFF"s), "5 x 3");
    EXPECT_EQ(size_of("BM"s + std::string(12, '\0') + "\x0C\0\0\0\x05\0\x04\0"s), "5 x 4");
    const std::string riff = "RIFF\0\0\0\0WEBP"s;
    EXPECT_EQ(size_of(riff + "VP8X\x0A\0\0\0\0\0\0\0\xFF\x3F\0\x01\0\0"s), "16384 x 2");
    EXPECT_EQ(size_of(riff + "VP8L\x05\0\0\0\x2F\x02\x40\0\0"s), "3 x 2");
    EXPECT_EQ(size_of(riff + "VP8 \x0A\0\0\0\0\0\0\x9D\x01\x2A\x07\x40\x08\0"s), "7 x 8");
    EXPECT_EQ(
        size_of("MM\0*\0\0\0\x08\0\x02\x01\0\0\x03\0\0\0\x01\0\x06\0\0\x01\x01\0\x04\0\0\0\x01\0\0\0\x07"s),
        "6 x 7");
    EXPECT_EQ(size_of("P5\n12 9\n255\n"), "12 x 9");
    EXPECT_EQ(size_of("\0\0\x0A"s + std::string(9, '\0') + "\x05\0\x04\0\x18\x20"s), "5 x 4");
    EXPECT_EQ(size_of("P4\n12 9\n"), "none");
    EXPECT_EQ(size_of("rubbish"), "none");
    EXPECT_EQ(size_of(""), "none");
    EXPECT_EQ(size_of("\xFF\xD8"), "none");
    EXPECT_EQ(size_of(png_header(0, 5)), "none");
}

class PictureFile : public FilesTest {};

TEST_F(PictureFile, SizesOfWrittenPicturesAreRead) {
    for (const char* name : {"a.png", "a.tiff"}) {
        write_numbers(folder_ / name, DnImage(31, 17));
        EXPECT_EQ(size_of(read_input_file(folder_ / name, picture_kind())), "31 x 17") << name;
        const Texture texture = read_picture(folder_ / name);
        EXPECT_EQ(texture.width, 31);
        EXPECT_EQ(texture.texels.size(), 31u * 17u);
    }
}

TEST_F(PictureFile, APictureOfTooManyPixelsIsRefusedBeforeItIsDecoded) {
    const auto file = write("bomb.png", png_header(30000, 30000));
    EXPECT_EXIT(
        {
            limit_this_process(512u << 20, 30);
            std::cerr << error_of([&] { read_picture(file); });
            _exit(0);
        },
        testing::ExitedWithCode(0),
        "bomb.png: has 30000 x 30000 pixels; accepted: at most 268435456, as 16384 x 16384");
    EXPECT_THAT(error_of([&] { read_pixel_map(file, false); }), HasSubstr("30000 x 30000 pixels"));
}

}  // namespace
}  // namespace hilcam
