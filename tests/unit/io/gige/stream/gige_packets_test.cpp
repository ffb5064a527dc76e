#include "io/gige/stream/gige_packets.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "io/system/bytes.h"

namespace hilcam {
namespace {

DnImage ramp(int width, int height) {
    DnImage image(width, height);
    for (std::size_t i = 0; i < image.pixels(); ++i) image.data()[i] = static_cast<std::uint16_t>(i & 0xFFF);
    return image;
}

GigeStreamState stream_of(std::uint32_t width, std::uint32_t height) {
    GigeStreamState s;
    s.packet_bytes = 576;
    s.format = WireFormat::kMono12;
    s.width = width;
    s.height = height;
    return s;
}

FrameRecord twelve_bits() {
    FrameRecord record;
    record.bits = 12;
    return record;
}

struct Built {
    GigeFrame frame;
    std::vector<std::uint8_t> payload;
    Built(const GigeStreamState& s, const FrameRecord& record = twelve_bits(), BayerPattern pattern = {})
        : payload(s.payload_bytes() + 1, 0xEE) {
        std::vector<std::uint16_t> scratch(3 * s.width + 8);
        write_gige_payload(ramp(100, 80), record, s, pattern, 99, scratch,
                           std::span(payload).first(s.payload_bytes()));
        EXPECT_EQ(payload.back(), 0xEE);
        payload.pop_back();
        frame = {s, pattern, 0x10005, 99, 0, payload};
    }
};

// What a receiver does that knows nothing but the packets: GVSP says where a packet's bytes belong.
std::vector<std::uint8_t> received(const GigeFrame& frame) {
    const GigeStreamState& s = frame.stream;
    std::vector<std::uint8_t> out(s.payload_bytes(), 0xDD);
    for (std::uint32_t id = 1; id < trailer_id(s); ++id) {
        const GigePacket p = packet_of(frame, id, gvsp::kFresh);
        const std::size_t header = gvsp::header_bytes(s.long_ids());
        std::size_t at = (id - 1) * (s.packet_bytes - 28 - header);
        if (p.head[4] == (0x80 | gvsp::kMultipart)) {
            EXPECT_EQ(p.head_bytes, header + 8);
            ByteReader prefix(std::span(p.head).subspan(header + 2, 6));
            at = std::size_t{prefix.u16()} << 32;
            at += prefix.u32();
        }
        EXPECT_LE(28 + p.bytes(), s.packet_bytes);
        EXPECT_LE(at + p.data.size(), out.size());
        if (at + p.data.size() > out.size()) return {};
        std::copy(p.data.begin(), p.data.end(), out.begin() + static_cast<std::ptrdiff_t>(at));
    }
    return out;
}

TEST(GigePackets, PutTogetherTheyAreThePayload) {
    for (const bool extended : {false, true})
        for (const bool chunks : {false, true})
            for (const bool multipart : {false, true})
                for (const std::uint32_t width : {1u, 7u, 64u, 100u}) {
                    GigeStreamState s = stream_of(width, 33);
                    s.extended_ids = extended;
                    s.multipart = multipart;
                    s.components = 3;
                    s.chunk_mode = chunks;
                    s.chunks = chunks ? 0x7FFF : 0;
                    const Built b(s);
                    EXPECT_EQ(received(b.frame), b.payload) << extended << chunks << multipart << width;
                }
}

TEST(GigePackets, AllButTheLastAreFull) {
    GigeStreamState s = stream_of(100, 80);
    s.packet_bytes = 1500;
    // 16000 bytes by 1464: ten full ones and 1360.
    const Built b(s);
    EXPECT_EQ(trailer_id(s), 12u);
    for (std::uint32_t id = 1; id <= 10; ++id) EXPECT_EQ(packet_of(b.frame, id, gvsp::kFresh).bytes(), 1472u);
    EXPECT_EQ(packet_of(b.frame, 11, gvsp::kFresh).data.size(), 1360u);
    // An exact multiple has no empty packet.
    s.packet_bytes = 16000 / 10 + 36;
    EXPECT_EQ(trailer_id(s), 11u);
}

TEST(GigePackets, TheLeaderTellsTheWindowAndItsMosaic) {
    GigeStreamState s = stream_of(60, 40);
    s.offset_x = 3, s.offset_y = 6;
    s.format = WireFormat::kBayer12;
    const Built b(s, twelve_bits(), "RGGB");
    const GigePacket p = packet_of(b.frame, 0, gvsp::kFresh);
    ASSERT_EQ(p.head_bytes, 44u);
    ByteReader in(std::span(p.head).subspan(2));
    EXPECT_EQ(in.u16(), 5u);  // short ids: the low 16 bits
    in.skip(8);
    EXPECT_EQ(in.u64(), 99u);
    EXPECT_EQ(in.u32(), 0x01100010u);  // BayerGR12: one column further than RG
    EXPECT_EQ(in.u32(), 60u);
    EXPECT_EQ(in.u32(), 40u);
    EXPECT_EQ(in.u32(), 3u);
    EXPECT_EQ(in.u32(), 6u);
}

TEST(GigePackets, AWrongHeightIsOnlyInTheTrailer) {
    Built b(stream_of(60, 40));
    const auto height = [&] {
        const GigePacket p = packet_of(b.frame, trailer_id(b.frame.stream), gvsp::kFresh);
        return ByteReader(std::span(p.head).subspan(12, 4)).u32();
    };
    EXPECT_EQ(height(), 40u);
    b.frame.size_y_error = -3;
    EXPECT_EQ(height(), 37u);
}

// As clients read chunks: from the end backwards, by the lengths.
TEST(GigePackets, ChunksAreFoundFromTheEnd) {
    FrameRecord record = twelve_bits();
    record.id = 77;
    record.exposure_mid.ns = -5;
    record.exposure_s = 0.0025;
    record.gain_db = 6.5;
    record.black_level_dn = 64;
    record.pose_sequence = 4242;
    record.pose_time.ns = 1'000'000'007;
    record.trigger_sequence = 9;
    record.faults = 0x8000000000000001;
    record.sequencer_set = 5;
    GigeStreamState s = stream_of(60, 40);
    s.offset_x = 2, s.offset_y = 4;
    s.chunk_mode = true;
    s.chunks = (1u << kChunks) - 1;
    const auto f64 = [](double v) { return std::bit_cast<std::uint64_t>(v); };
    const std::vector<std::uint64_t> expected = {77,
                                                 99,
                                                 f64(2500),
                                                 f64(6.5),
                                                 f64(64),
                                                 2,
                                                 4,
                                                 60,
                                                 40,
                                                 0x01100005,
                                                 4242,
                                                 1'000'000'007,
                                                 static_cast<std::uint64_t>(-5),
                                                 9,
                                                 0x8000000000000001,
                                                 5};
    const Built b(s, record);
    std::size_t end = b.payload.size();
    for (int i = kChunks; i-- > -1;) {
        ByteReader tail(std::span(b.payload).subspan(end - 8, 8));
        const std::uint32_t id = tail.u32(), length = tail.u32();
        end -= 8 + std::size_t{length};
        if (i == -1) {
            EXPECT_EQ(id, kImageChunkId);
            EXPECT_EQ(length, s.image_bytes());
            EXPECT_EQ(end, 0u);
            break;
        }
        EXPECT_EQ(id, kChunkIdBase + static_cast<std::uint32_t>(i));
        ByteReader data(std::span(b.payload).subspan(end, length));
        EXPECT_EQ(length == 4 ? data.u32() : data.u64(), expected[static_cast<std::size_t>(i)]) << i;
    }
}

TEST(GigePackets, OnlyChosenChunksAreSent) {
    GigeStreamState s = stream_of(60, 40);
    s.chunk_mode = true;
    s.chunks = 1u << static_cast<int>(Chunk::kGain) | 1u << static_cast<int>(Chunk::kWidth);
    EXPECT_EQ(s.payload_bytes(), 4800u + 8 + 16 + 12);
    const Built b(s);
    EXPECT_EQ(ByteReader(std::span(b.payload).last(8)).u64(),
              std::uint64_t{kChunkIdBase + static_cast<unsigned>(Chunk::kWidth)} << 32 | 4);
    const GigePacket trailer = packet_of(b.frame, trailer_id(s), gvsp::kFresh);
    ByteReader in(std::span(trailer.head).subspan(8));
    EXPECT_EQ(in.u32(), 0x4001u);
    EXPECT_EQ(in.u32(), 40u);
    EXPECT_EQ(in.u32(), s.payload_bytes());
}

TEST(GigePackets, SentAgainOnlyTheStatusDiffers) {
    GigeStreamState s = stream_of(60, 40);
    s.extended_ids = true;
    const Built b(s);
    for (std::uint32_t id = 0; id <= trailer_id(s); ++id) {
        GigePacket first = packet_of(b.frame, id, gvsp::kFresh),
                   again = packet_of(b.frame, id, gvsp::kResent);
        EXPECT_EQ(again.head[0], 1);
        EXPECT_EQ(again.head[3], 1);
        EXPECT_TRUE(std::equal(first.head.begin() + 4,
                               first.head.begin() + static_cast<std::ptrdiff_t>(first.head_bytes),
                               again.head.begin() + 4));
        EXPECT_EQ(first.data.data(), again.data.data());
        EXPECT_EQ(first.data.size(), again.data.size());
    }
}

TEST(GigePackets, MultipartFramesAreAnImageItsConfidenceAndItsChunks) {
    GigeStreamState s = stream_of(60, 40);
    s.multipart = s.chunk_mode = true;
    s.components = 3;
    s.chunks = 1;
    const Built b(s);
    const GigePacket leader = packet_of(b.frame, 0, gvsp::kFresh);
    // Multipart brings 64-bit ids with it, asked for or not; the byte before them counts the parts.
    EXPECT_EQ(leader.head[4], 0x80 | gvsp::kLeader);
    EXPECT_EQ(leader.head[7], 3);
    ASSERT_EQ(leader.head_bytes, 20u + 12 + 3 * 48);
    const std::array<std::array<std::uint32_t, 5>, 3> parts = {{{1, 4800, 0x01100005, 1, 60},  // Mono12
                                                                {9, 2400, 0x010800C6, 6, 60},  // Confidence8
                                                                {0x0A, 8 + 16, 0, 0, 0}}};
    ByteReader in(std::span(leader.head).subspan(32));
    for (const auto& [type, bytes, format, purpose, width] : parts) {
        EXPECT_EQ(in.u16(), type);
        EXPECT_EQ(in.u16(), 0u);
        EXPECT_EQ(in.u32(), bytes);
        EXPECT_EQ(in.u32(), format);
        in.skip(8);
        EXPECT_EQ(in.u16(), purpose);
        in.skip(2);
        EXPECT_EQ(in.u32(), width);
        in.skip(20);
    }
    // The ramp begins with DN 0 and comes to 4095 in row 40.
    EXPECT_EQ(b.payload[4800], 0);
    EXPECT_EQ(std::count(b.payload.begin() + 4800, b.payload.begin() + 7200, 255), 2399);
}

TEST(GigePackets, APixelAtFullScaleIsNotBelieved) {
    GigeStreamState s = stream_of(100, 41);
    s.multipart = true;
    s.components = 3;
    const Built b(s);
    const auto of = [&](std::size_t pixel) { return b.payload[2 * 4100 + pixel]; };
    EXPECT_EQ(of(4094), 255);
    EXPECT_EQ(of(4095), 0);
    EXPECT_EQ(of(4096), 0);  // DN 0 again
}

TEST(GigePackets, TheLargestPayloadHoldsEveryFormatAndAllChunks) {
    // Image tail; 8 chunks of 8 bytes and 7 of 4, each with its id and length.
    constexpr std::size_t kAllChunks = 8 + 8 * 16 + 8 * 12;
    EXPECT_EQ(max_payload_bytes(101, 51, "", false), 3u * 101 * 51 + kAllChunks);
    EXPECT_EQ(max_payload_bytes(101, 51, "RGGB", false), 3u * 101 * 51 + kAllChunks);
    EXPECT_EQ(max_payload_bytes(101, 51, "", true), 4u * 101 * 51 + kAllChunks);
}

}  // namespace
}  // namespace hilcam
