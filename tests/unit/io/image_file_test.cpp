#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/image_file.h"
#include "io/picture_file.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

class PixelMapTest : public FilesTest {};

TEST_F(PixelMapTest, NumbersComeAsTheyAre) {
    DnImage picture(5, 3);
    picture.row(2)[4] = 1234;
    write_frame(folder_ / "map.tiff", picture);
    const PixelMap map = read_pixel_map(folder_ / "map.tiff", false);
    EXPECT_EQ(map.width(), 5);
    EXPECT_EQ(map.height(), 3);
    EXPECT_EQ(map.row(2)[4], 1234.0f);
    EXPECT_EQ(map.row(0)[0], 0.0f);
}

TEST_F(PixelMapTest, WhatIsNoMapIsRefusedByName) {
    EXPECT_THAT(error_of([&] { read_pixel_map(folder_ / "none.tiff", false); }),
                HasSubstr("none.tiff: cannot be read: No such file"));
    write("text.tiff", "not a picture");
    EXPECT_THAT(error_of([&] { read_pixel_map(folder_ / "text.tiff", false); }),
                HasSubstr("does not decode"));
    // A picture with three channels: a PPM of one pixel.
    write("color.ppm", std::string("P6\n1 1\n255\n") + "abc");
    EXPECT_THAT(error_of([&] { read_pixel_map(folder_ / "color.ppm", false); }),
                HasSubstr("has 3 channels; accepted: one"));
    // A PFM of one negative number.
    write("negative.pfm", std::string("Pf\n1 1\n-1.0\n") + std::string("\x00\x00\x80\xbf", 4));
    EXPECT_THAT(error_of([&] { read_pixel_map(folder_ / "negative.pfm", false); }),
                HasSubstr("pixel (0, 0) is -1.000000; accepted: finite, not negative"));
    EXPECT_EQ(read_pixel_map(folder_ / "negative.pfm", true).row(0)[0], -1.0f);
}

}  // namespace
}  // namespace hilcam
