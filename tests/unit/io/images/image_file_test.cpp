#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "io/images/exr_file.h"
#include "io/images/image_file.h"
#include "io/images/picture_codecs.h"
#include "io/images/picture_file.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

using namespace std::string_literals;

// TIFF 6.0: one pixel, a 32-bit float, little-endian.
std::string float_tiff(const std::string& number) {
    std::string out = "II*\0\x0C\0\0\0"s + number + "\x08\0"s;
    const auto add = [&out](int tag, char value) {
        out += {static_cast<char>(tag & 255), static_cast<char>(tag >> 8), 3, 0, 1, 0, 0, 0, value, 0, 0, 0};
    };
    // Width, height, bits, compression (none), black is zero, where the number is, how long, a float.
    for (const auto& [tag, value] : std::vector<std::pair<int, char>>{
             {256, 1}, {257, 1}, {258, 32}, {259, 1}, {262, 1}, {273, 8}, {279, 4}, {339, 3}})
        add(tag, value);
    return out + "\0\0\0\0"s;
}

class PixelMapTest : public FilesTest {};

TEST_F(PixelMapTest, NumbersComeAsTheyAre) {
    DnImage picture(5, 3);
    picture.row(2)[4] = 1234;
    write_numbers(folder_ / "map.tiff", picture);
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
    EXPECT_THAT(error_of([&] { read_pixel_map(write("bits.pbm", "P4\n1 1\na"), false); }),
                HasSubstr("bits.pbm: does not decode; accepted: PNG, JPEG, TIFF, BMP, WebP"));
    EXPECT_EQ(read_pixel_map(write("grey.pgm", "P5\n1 1\n255\na"), false).row(0)[0], 'a');
    const std::vector<std::uint8_t> color = {1, 2, 3};
    write("color.png", encode_png({color, 1, 1, SampleKind::kRgb8}));
    EXPECT_THAT(error_of([&] { read_pixel_map(folder_ / "color.png", false); }),
                HasSubstr("color.png: has 3 channels; accepted: one"));
    const auto negative = write("negative.tiff", float_tiff("\x00\x00\x80\xbf"s));
    EXPECT_THAT(error_of([&] { read_pixel_map(negative, false); }),
                HasSubstr("pixel (0, 0) is -1.000000; accepted: finite, not negative"));
    EXPECT_EQ(read_pixel_map(negative, true).row(0)[0], -1.0f);
    const auto nothing = write("nothing.tiff", float_tiff("\x00\x00\xc0\x7f"s));
    EXPECT_THAT(error_of([&] { read_pixel_map(nothing, true); }),
                HasSubstr("pixel (0, 0) is nan; accepted: finite"));
}

// A picture of 6 x 5 px about a frame of 2 x 1 px, two px from its left and top.
TEST_F(PixelMapTest, ARadianceImageSaysWhereItsFrameIs) {
    RadianceImage radiance(6, 5, 1);
    radiance.row(2)[2] = 7, radiance.row(0)[0] = 3;
    write_radiance_exr(folder_ / "radiance.exr", radiance, SpectralGrid({0.5, 0.7}), {2, 2, 2, 1}, {});

    Imf::InputFile in((folder_ / "radiance.exr").c_str());
    EXPECT_EQ(in.header().displayWindow(), Imath::Box2i({0, 0}, {1, 0}));
    const Imath::Box2i data = in.header().dataWindow();
    EXPECT_EQ(data, Imath::Box2i({-2, -2}, {3, 2}));
    std::vector<float> values(6 * 5);
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, values.data(), data));
    in.setFrameBuffer(buffer);
    in.readPixels(data.min.y, data.max.y);
    EXPECT_EQ(values[2 * 6 + 2], 7);  // the frame's pixel (0, 0)
    EXPECT_EQ(values[0], 3);

    write_electrons_exr(folder_ / "electrons.exr", ElectronImage(2, 1), {});
    Imf::InputFile electrons((folder_ / "electrons.exr").c_str());
    EXPECT_EQ(electrons.header().displayWindow(), in.header().displayWindow());
    EXPECT_EQ(electrons.header().dataWindow(), in.header().displayWindow());
}

// Bins in blue, green, red and the near infrared; notes are attributes of their types.
TEST_F(PixelMapTest, ARadianceImageOfSeveralBinsHasColoursForViewers) {
    RadianceImage radiance(2, 1, 4);
    for (int b = 0; b < 4; ++b) radiance.row(0, b)[1] = static_cast<float>(b + 1);
    const PictureNotes notes = {{"seed", "SEED", std::int64_t{77}, ""},
                                {"exposure_s", "EXPTIME", 0.25, ""},
                                {"position_m", "CAMPOS", std::vector{1.0, 2.0, 3.0}, ""}};
    write_radiance_exr(folder_ / "radiance.exr", radiance, SpectralGrid({0.4, 0.48, 0.57, 0.69, 0.93}),
                       {0, 0, 2, 1}, notes);
    Imf::InputFile in((folder_ / "radiance.exr").c_str());
    std::vector<std::string> names;
    for (auto channel = in.header().channels().begin(); channel != in.header().channels().end(); ++channel)
        names.emplace_back(channel.name());
    EXPECT_THAT(names, testing::ElementsAre("B", "G", "L_0.400_0.480um", "L_0.480_0.570um", "L_0.570_0.690um",
                                            "L_0.690_0.930um", "R"));
    std::map<std::string, std::array<float, 2>> values;
    Imf::FrameBuffer buffer;
    for (const char* name : {"R", "G", "B", "L_0.690_0.930um"})
        buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, values[name].data(), in.header().dataWindow()));
    in.setFrameBuffer(buffer);
    in.readPixels(0, 0);
    EXPECT_EQ(values["L_0.690_0.930um"][1], 4);
    EXPECT_NEAR(values["B"][1], 1, 0.2);  // the green bin begins in the ramp between the bands
    EXPECT_NEAR(values["G"][1], 2, 0.2);
    EXPECT_NEAR(values["R"][1], (3 * 0.12 + 4 * 0.24) / 0.36, 0.05);  // bins count by their widths
    EXPECT_EQ(in.header().typedAttribute<Imf::StringAttribute>("seed").value(), "77");
    EXPECT_EQ(in.header().typedAttribute<Imf::DoubleAttribute>("exposure_s").value(), 0.25);
    EXPECT_EQ(in.header().typedAttribute<Imf::V3dAttribute>("position_m").value(), Imath::V3d(1, 2, 3));

    write_radiance_exr(folder_ / "infrared.exr", radiance, SpectralGrid({0.7, 0.75, 0.8, 0.85, 0.9}),
                       {0, 0, 2, 1}, {});
    Imf::InputFile infrared((folder_ / "infrared.exr").c_str());
    EXPECT_NE(infrared.header().channels().findChannel("Y"), nullptr);
    EXPECT_EQ(infrared.header().channels().findChannel("R"), nullptr);
}

TEST_F(PixelMapTest, ADecodersReasonIsInTheMessageAndNotOnTheTerminal) {
    DnImage picture(64, 64);
    write_numbers(folder_ / "whole.png", picture);
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
