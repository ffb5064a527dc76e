// What hilcam makes of a frame for V4L2, and what it knows of v4l2loopback's versions. Devices themselves are
// tested in a machine that has some: tools/check-devices.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include "io/commands/ccsds.h"
#include "io/contract/fault.h"
#include "io/v4l2/sink_v4l2.h"
#include "io/v4l2/v4l2_metadata_row.h"
#include "render/vocabulary/check.h"
#include "tests/support/quiet_camera.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

std::string refusal(const std::function<void()>& act) {
    try {
        act();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "";
}

TEST(V4l2Formats, EveryPhaseOfAMosaicHasItsCode) {
    EXPECT_EQ(fourcc_text(pixels_of(V4l2Format::kBayer8, "RGGB", 8).fourcc), "RGGB");
    EXPECT_EQ(fourcc_text(pixels_of(V4l2Format::kBayer8, "BGGR", 8).fourcc), "BA81");
    EXPECT_EQ(fourcc_text(pixels_of(V4l2Format::kBayer10, "GRBG", 8).fourcc), "BA10");
    EXPECT_EQ(fourcc_text(pixels_of(V4l2Format::kBayer12, "GBRG", 8).fourcc), "GB12");
    EXPECT_EQ(pixels_of(V4l2Format::kBayer12, "GBRG", 8).bytes_per_pixel, 2u);
    EXPECT_EQ(fourcc_text(V4L2_PIX_FMT_Y16), "Y16 ");
    EXPECT_EQ(fourcc_text(0x01020304), "....");
}

TEST(V4l2Formats, WhatACameraHasNotIsRefused) {
    EXPECT_THAT(refusal([] { pixels_of(V4l2Format::kBayer8, "", 8); }),
                HasSubstr("the camera has no colour filters; accepted: GREY, Y16, YUYV, RGB24"));
    EXPECT_THAT(refusal([] { pixels_of(V4l2Format::kBayer10, "RCCB", 8); }), HasSubstr("'RCCB'"));
    EXPECT_THAT(refusal([] { pixels_of(V4l2Format::kYuyv, "", 7); }), HasSubstr("7, accepted: an even one"));
}

TEST(V4l2Formats, AFlipIsAnotherFormatOfAnotherDepth) {
    const auto deep = [](V4l2Format f) {
        return f == V4l2Format::kY16 || f == V4l2Format::kBayer10 || f == V4l2Format::kBayer12;
    };
    for (int i = 0; i <= static_cast<int>(V4l2Format::kRgb24); ++i) {
        const auto format = static_cast<V4l2Format>(i);
        EXPECT_NE(deep(format), deep(flipped(format))) << i;
    }
}

TEST(V4l2MetadataRow, ComesBackAsItWent) {
    FrameRecord record;
    record.id = 0x0102030405060708;
    record.exposure_mid.ns = -5;
    record.exposure_mid_monotonic_ns = 123456789012345;
    record.exposure_s = 0.0015;
    record.gain_db = -3.5;
    record.pose_sequence = 0xFFFFFFFE;
    record.trigger_sequence = 9;
    record.pose_time.ns = 7;
    record.faults = std::uint64_t{1} << 40;
    record.quality_level = 2;
    record.bits = 14;
    std::vector<std::uint8_t> row(100, 0xAA);
    write_metadata_row(record, row);
    const auto back = read_metadata_row(row);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->id, record.id);
    EXPECT_EQ(back->exposure_mid.ns, -5);
    EXPECT_EQ(back->exposure_mid_monotonic_ns, record.exposure_mid_monotonic_ns);
    EXPECT_EQ(back->exposure_s, 0.0015);
    EXPECT_EQ(back->gain_db, -3.5);
    EXPECT_EQ(back->pose_sequence, 0xFFFFFFFE);
    EXPECT_EQ(back->trigger_sequence, 9u);
    EXPECT_EQ(back->pose_time.ns, 7);
    EXPECT_EQ(back->faults, record.faults);
    EXPECT_EQ(back->quality_level, 2u);
    EXPECT_EQ(back->bits, 14);
}

// The layout is part of the interface: bytes at their places, big-endian, a CRC over the first 78.
TEST(V4l2MetadataRow, LiesAsDocumented) {
    FrameRecord record;
    record.id = 0x1122334455667788;
    record.bits = 12;
    std::vector<std::uint8_t> row(96, 0xAA);
    write_metadata_row(record, row);
    EXPECT_EQ(std::string(row.begin(), row.begin() + 4), "HCMR");
    EXPECT_EQ(row[5], 1);
    EXPECT_EQ(row[7], kMetadataBytes);
    EXPECT_EQ(row[8], 0x11);
    EXPECT_EQ(row[15], 0x88);
    EXPECT_EQ(row[77], 12);
    EXPECT_EQ(crc16(std::span(row).first(78)), row[78] << 8 | row[79]);
    EXPECT_EQ(row[80], 0);
    EXPECT_EQ(row[95], 0);
}

TEST(V4l2MetadataRow, ABadOneIsNone) {
    std::vector<std::uint8_t> row(kMetadataBytes);
    EXPECT_FALSE(read_metadata_row(row));  // CRC of zeros is not zero
    write_metadata_row({}, row);
    EXPECT_TRUE(read_metadata_row(row));
    EXPECT_FALSE(read_metadata_row(std::span(row).first(kMetadataBytes - 1)));
    for (std::size_t bit = 0; bit < 8 * row.size(); ++bit) {
        row[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
        EXPECT_FALSE(read_metadata_row(row)) << bit;
        row[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
    }
}

TEST(V4l2Module, VersionsAndTheirTraps) {
    EXPECT_EQ(parse_loopback_version("0.15.0"), (LoopbackVersion{0, 15, 0}));
    EXPECT_EQ(parse_loopback_version("0.13.2-dirty"), (LoopbackVersion{0, 13, 2}));
    for (const char* text : {"", "0.13", "x.1.2", "0.13.", "0..1", "-1.2.3"})
        EXPECT_FALSE(parse_loopback_version(text)) << text;
    EXPECT_LT((LoopbackVersion{0, 9, 9}), (LoopbackVersion{0, 14, 0}));
    EXPECT_FALSE(LoopbackModule{}.shared_queue());
    EXPECT_TRUE((LoopbackModule{true, {}}).shared_queue());
    EXPECT_TRUE((LoopbackModule{true, LoopbackVersion{0, 13, 2}}).shared_queue());
    EXPECT_FALSE((LoopbackModule{true, LoopbackVersion{0, 14, 0}}).shared_queue());
    EXPECT_FALSE((LoopbackModule{true, {}}).counts_mapped_frames());
    EXPECT_EQ((LoopbackModule{true, {}}).name(), "before 0.13");
}

struct V4l2SinkConfig : testing::Test {
    QuietCamera camera;
    FaultBoard faults;
    SinkContext context{camera, faults};
    V4l2Config config;
};

TEST_F(V4l2SinkConfig, AMetadataRowMustFit) {
    config.metadata_row = V4l2Config::MetadataRow::kBottom;
    EXPECT_THAT(refusal([&] { V4l2Sink(config, 39, 8, 10, context); }),
                HasSubstr("needs lines of 80 bytes; this picture's have 78"));
    V4l2Sink(config, 40, 8, 10, context);
    camera.pattern = "RGGB";
    config.format = V4l2Format::kBayer12;
    V4l2Sink(config, 40, 8, 10, context);
    config.metadata_row = V4l2Config::MetadataRow::kTop;
    EXPECT_THAT(refusal([&] { V4l2Sink(config, 40, 8, 10, context); }), HasSubstr("phase of a mosaic"));
}

TEST_F(V4l2SinkConfig, AMissingDeviceSaysWhatToDo) {
    config.device = "/dev/no-such-video";
    V4l2Sink sink(config, 40, 8, 10, context);
    const std::string text = refusal([&] { sink.start(); });
    EXPECT_THAT(text, HasSubstr("/dev/no-such-video: cannot be opened: No such file"));
    EXPECT_THAT(text, HasSubstr("modprobe v4l2loopback"));
    config.device = "/dev/null";
    V4l2Sink other(config, 40, 8, 10, context);
    EXPECT_THAT(refusal([&] { other.start(); }), HasSubstr("is not a V4L2 device"));
}

}  // namespace
}  // namespace hilcam
