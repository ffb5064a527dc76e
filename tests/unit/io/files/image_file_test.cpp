#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/files/image_file.h"
#include "io/files/picture_file.h"
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
                HasSubstr("none.tiff: no such file"));
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

// A picture of 6 x 5 px about a frame of 2 x 1 px, two px from its left and top.
TEST_F(PixelMapTest, ARadianceImageSaysWhereItsFrameIs) {
    RadianceImage radiance(6, 5, 1);
    radiance.row(2)[2] = 7, radiance.row(0)[0] = 3;
    write_radiance_exr(folder_ / "radiance.exr", radiance, SpectralGrid({0.5, 0.7}), {2, 2, 2, 1});

    Imf::InputFile in((folder_ / "radiance.exr").c_str());
    EXPECT_EQ(in.header().displayWindow(), Imath::Box2i({0, 0}, {1, 0}));
    const Imath::Box2i data = in.header().dataWindow();
    EXPECT_EQ(data, Imath::Box2i({-2, -2}, {3, 2}));
    std::vector<float> values(6 * 5);
    Imf::FrameBuffer buffer;
    buffer.insert("L_0.500_0.700um", Imf::Slice::Make(Imf::FLOAT, values.data(), data));
    in.setFrameBuffer(buffer);
    in.readPixels(data.min.y, data.max.y);
    EXPECT_EQ(values[2 * 6 + 2], 7);  // the frame's pixel (0, 0)
    EXPECT_EQ(values[0], 3);

    write_electrons_exr(folder_ / "electrons.exr", ElectronImage(2, 1));
    Imf::InputFile electrons((folder_ / "electrons.exr").c_str());
    EXPECT_EQ(electrons.header().displayWindow(), in.header().displayWindow());
    EXPECT_EQ(electrons.header().dataWindow(), in.header().displayWindow());
}

TEST_F(PixelMapTest, ADecodersReasonIsInTheMessageAndNotOnTheTerminal) {
    DnImage picture(64, 64);
    write_frame(folder_ / "whole.png", picture);
    std::ifstream in(folder_ / "whole.png", std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    bytes[bytes.find("IDAT") + 20] ^= 0x55;
    write("broken.png", bytes);
    testing::internal::CaptureStderr();
    const std::string error = error_of([&] { read_pixel_map(folder_ / "broken.png", false); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_THAT(error, HasSubstr("does not decode (libpng"));
}

}  // namespace
}  // namespace hilcam
