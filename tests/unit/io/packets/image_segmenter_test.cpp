// Image packets byte by byte, against CCSDS 133.0-B-2 and 301.0-B-4.

#include "io/packets/image_segmenter.h"

#include <gmock/gmock.h>

#include <numeric>

#include "io/packets/cuc_time.h"
#include "io/packets/pixel_code.h"

namespace hilcam {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes cuc(std::int64_t ns) {
    Bytes bytes(kCucBytes);
    ByteWriter out(bytes);
    write_cuc({ns}, out);
    return bytes;
}

TEST(CucTime, CountsSecondsAndTheirFractionFrom1958) {
    // 1970-01-01 is 378,691,200 = 0x16925E80 s after 1958-01-01.
    EXPECT_EQ(cuc(0), (Bytes{0x9F, 0x04, 0x16, 0x92, 0x5E, 0x80, 0, 0, 0, 0}));
    EXPECT_EQ(cuc(500'000'000), (Bytes{0x9F, 0x04, 0x16, 0x92, 0x5E, 0x80, 0x80, 0, 0, 0}));
    EXPECT_EQ(cuc(-750'000'000), (Bytes{0x9F, 0x04, 0x16, 0x92, 0x5E, 0x7F, 0x40, 0, 0, 0}));
    // 2^32 s after 1958 the seconds begin anew.
    EXPECT_EQ(cuc((4294967296 - 378691200) * kSecond_ns), (Bytes{0x9F, 0x04, 0, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(CucTime, WholeNanosecondsComeBack) {
    for (const std::int64_t ns : {1, 2, 3, 123'456'789, 999'999'999}) {
        const Bytes bytes = cuc(ns);
        std::uint64_t fraction = 0;
        for (std::size_t i = 6; i < 10; ++i) fraction = fraction << 8 | bytes[i];
        EXPECT_EQ((fraction * 1'000'000'000 + (std::uint64_t{1} << 31)) >> 32,
                  static_cast<std::uint64_t>(ns));
    }
}

TEST(PixelCode, IsThatOfPfnc) {
    EXPECT_EQ(pixel_code(12, false, ""), 0x01100005u);
    EXPECT_EQ(pixel_code(12, true, ""), 0x010C0047u);
    EXPECT_EQ(pixel_code(11, false, ""), 0x01100005u);
    EXPECT_EQ(pixel_code(11, true, ""), 0x01100005u);  // PFNC has no Mono11p
    EXPECT_EQ(pixel_code(8, true, ""), 0x01080001u);
    EXPECT_EQ(pixel_code(10, true, "RGGB"), 0x010A0058u);
    EXPECT_EQ(pixel_code(12, false, "BGGR"), 0x01100013u);
    EXPECT_EQ(pixel_code(14, true, "GBRG"), 0x010E0107u);
    EXPECT_EQ(pixel_code(16, false, "GRBG"), 0x0110002Eu);
}

ImageFrame a_frame() {
    return {.exposure_mid = {1'500'000'000},
            .payload = Payload::kPacked,
            .bits = 12,
            .reverse_y = true,
            .binning_x = 2,
            .binning_y = 4,
            .width = 0x0102,
            .height = 0x0304,
            .offset_x = 0x0506,
            .offset_y = 0x0708,
            .pixel_code = 0x010C0047,
            .frame = 0x1112131415161718,
            .exposure_s = 0.5};
}

TEST(ImageHeader, HasEachFieldAtItsPlace) {
    Bytes bytes(kImageHeaderBytes);
    write_image_header(a_frame(), {0x0910, 0x2122, 0x31323334, 0x41424344, 0x51525354, 0x61626364}, bytes);
    EXPECT_EQ(bytes, (Bytes{0x9F, 0x04, 0x16, 0x92, 0x5E, 0x81, 0x80, 0,    0, 0,  // time
                            1,    2,    12,   2,    2,    4,                       // version, payload, ...
                            0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x07, 0x08,        // size, offset
                            0x09, 0x10, 0x21, 0x22,                                // strip
                            0x01, 0x0C, 0x00, 0x47,                                // pixel format
                            0x11, 0x12, 0x13, 0x14, 0x15, 0x16, 0x17, 0x18,        // frame
                            0x3F, 0xE0, 0,    0,    0,    0,    0,    0,           // 0.5
                            0x31, 0x32, 0x33, 0x34, 0x41, 0x42, 0x43, 0x44,        // segment of
                            0x51, 0x52, 0x53, 0x54, 0x61, 0x62, 0x63, 0x64}));     // bytes
}

std::vector<Bytes> packets_of(ImageSegmenter& segmenter, const Bytes& payload,
                              const std::vector<StripPayload>& strips) {
    std::vector<Bytes> out;
    segmenter.begin(a_frame(), payload, strips);
    for (auto packet = segmenter.next(); !packet.empty(); packet = segmenter.next())
        out.emplace_back(packet.begin(), packet.end());
    return out;
}
unsigned flags_of(const Bytes& packet) { return packet[2] >> 6; }
unsigned count_of(const Bytes& packet) { return (packet[2] & 0x3Fu) << 8 | packet[3]; }
unsigned length_of(const Bytes& packet) { return unsigned{packet[4]} << 8 | packet[5]; }
Bytes data_of(const Bytes& packet, std::size_t crc_bytes) {
    return {packet.begin() + 70, packet.end() - static_cast<std::ptrdiff_t>(crc_bytes)};
}

TEST(ImageSegmenter, CutsAFrameIntoAGroupOfPackets) {
    ImageSegmenter segmenter(0x123, 128, true);  // 56 bytes of data each
    Bytes payload(150);
    std::iota(payload.begin(), payload.end(), std::uint8_t{0});
    const auto packets = packets_of(segmenter, payload, {{0, 8, 0, 150}});
    ASSERT_EQ(packets.size(), 3u);
    const std::vector<unsigned> flags = {flags_of(packets[0]), flags_of(packets[1]), flags_of(packets[2])};
    EXPECT_EQ(flags, (std::vector<unsigned>{1, 0, 2}));
    Bytes all;
    for (std::size_t i = 0; i < packets.size(); ++i) {
        const Bytes& p = packets[i];
        EXPECT_EQ(p[0], 0x09) << "version 0, telemetry, secondary header, upper bits of the APID";
        EXPECT_EQ(p[1], 0x23);
        EXPECT_EQ(count_of(p), i);
        EXPECT_EQ(length_of(p) + 7, p.size());
        EXPECT_EQ(crc16(p), 0) << "a packet with its CRC";
        EXPECT_EQ(p[6 + 13], 2 | 4) << "mirrored up and down, with a CRC";
        EXPECT_EQ(p[6 + 51], i) << "segment";
        EXPECT_EQ(p[6 + 55], 3) << "segments";
        EXPECT_EQ(p[6 + 59], 56 * i) << "offset";
        const Bytes data = data_of(p, 2);
        all.insert(all.end(), data.begin(), data.end());
    }
    EXPECT_EQ(packets[0].size(), 128u);
    EXPECT_EQ(all, payload);
}

TEST(ImageSegmenter, OnePacketIsUnsegmentedAndNeedsNoCrc) {
    ImageSegmenter segmenter(1, 128, false);
    const auto packets = packets_of(segmenter, Bytes(58, 7), {{0, 2, 0, 58}});
    ASSERT_EQ(packets.size(), 1u);
    EXPECT_EQ(flags_of(packets[0]), 3u);
    EXPECT_EQ(packets[0].size(), 128u);
    EXPECT_EQ(packets[0][6 + 13], 2) << "no CRC";
    EXPECT_EQ(data_of(packets[0], 0), Bytes(58, 7));
}

TEST(ImageSegmenter, NoPacketHasPartsOfTwoStrips) {
    ImageSegmenter segmenter(1, 128, true);
    Bytes payload(70);
    std::iota(payload.begin(), payload.end(), std::uint8_t{0});
    const auto packets = packets_of(segmenter, payload, {{0, 4, 0, 10}, {4, 2, 10, 60}});
    ASSERT_EQ(packets.size(), 3u);
    EXPECT_EQ(data_of(packets[0], 2).size(), 10u);
    EXPECT_EQ(data_of(packets[1], 2).size(), 56u);
    EXPECT_EQ(data_of(packets[2], 2), (Bytes{66, 67, 68, 69}));
    EXPECT_EQ(packets[1][6 + 25], 4) << "first row of the second strip";
    EXPECT_EQ(packets[1][6 + 27], 2) << "its rows";
    EXPECT_EQ(packets[1][6 + 59], 0) << "offset in it";
    EXPECT_EQ(packets[1][6 + 63], 60) << "its bytes";
}

TEST(ImageSegmenter, TheCountGoesOnAndBeginsAnewAfter14Bits) {
    ImageSegmenter segmenter(1, 128, true);
    unsigned expected = 0;
    for (int i = 0; i < 8000; ++i)
        for (const Bytes& packet : packets_of(segmenter, Bytes(150), {{0, 1, 0, 150}}))
            ASSERT_EQ(count_of(packet), expected++ % 16384);
}

TEST(ImageSegmenter, PacketsThatAreLeftOutAreCounted) {
    ImageSegmenter segmenter(1, 128, true);
    const Bytes payload(150);
    const std::vector<StripPayload> strips = {{0, 1, 0, 150}};
    segmenter.begin(a_frame(), payload, strips);
    segmenter.next();
    segmenter.skip_rest();
    EXPECT_TRUE(segmenter.next().empty());
    EXPECT_EQ(count_of(packets_of(segmenter, payload, strips).front()), 3u);
}

TEST(ImageSegmenter, TheLongestPacketFillsItsLengthField) {
    ImageSegmenter segmenter(1, ImageSegmenter::kMostPacketBytes, true);
    const auto packets = packets_of(segmenter, Bytes(70000), {{0, 1, 0, 70000}});
    ASSERT_EQ(packets.size(), 2u);
    EXPECT_EQ(packets[0].size(), 65542u);
    EXPECT_EQ(length_of(packets[0]), 65535u);
}

}  // namespace
}  // namespace hilcam
