// Pictures from image packets, as tools/image_packets/hilcam_image.hpp puts them together. C++17.

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "tests/support/image_packet_writer.h"

namespace hilcam_image {
namespace {

std::vector<std::uint16_t> random_pixels(const Shape& s, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<std::uint16_t> pixels(std::size_t{s.width} * s.height);
    // Never 0, which is what a missing pixel has.
    for (std::uint16_t& dn : pixels) dn = static_cast<std::uint16_t>(1 + random() % ((1u << s.bits) - 1));
    return pixels;
}

struct Kept {
    Packet header;
    std::vector<std::uint16_t> pixels;
    std::vector<std::uint8_t> valid;
    std::size_t missing_pixels;
    std::uint32_t missing_packets;
};
void keep(void* pictures, const Picture& p) {
    const std::size_t count = std::size_t{p.header.width} * p.header.height;
    static_cast<std::vector<Kept>*>(pictures)->push_back({p.header,
                                                          {p.pixels, p.pixels + count},
                                                          {p.valid, p.valid + count},
                                                          p.missing_pixels,
                                                          p.missing_packets});
}

struct Reader {
    PictureReceiver receiver{0x110, 64 * 64};
    std::vector<Kept> pictures;
    void take(const std::vector<std::uint8_t>& bytes) {
        receiver.take(bytes.data(), bytes.size(), keep, &pictures);
    }
};

TEST(ImagePackets, HeadersComeBack) {
    Packet p;
    p.apid = 0x123, p.sequence_count = 0x3FFE, p.tai_ns = 1774015237123456789;
    p.payload = Payload::kPacked, p.bits = 12, p.reverse_y = true, p.binning_x = 2, p.binning_y = 4;
    p.width = 640, p.height = 480, p.offset_x = 7, p.offset_y = 9, p.first_row = 100, p.rows = 20;
    p.pixel_code = 0x010C0047, p.frame = 0x123456789AULL, p.exposure_s = 0.0125;
    p.segment = 3, p.segments = 70, p.strip_offset = 12, p.strip_bytes = 19200;
    for (const bool crc : {false, true}) {
        const auto bytes = packet_of(p, {1, 2, 3}, crc);
        EXPECT_EQ(packet_bytes(bytes.data(), bytes.size()), bytes.size());
        Packet q;
        ASSERT_EQ(read_packet(bytes.data(), bytes.size(), q), Fault::kNone);
        EXPECT_EQ(q.apid, p.apid);
        EXPECT_EQ(q.sequence_count, p.sequence_count);
        EXPECT_EQ(q.tai_ns, p.tai_ns);
        EXPECT_EQ(q.payload, p.payload);
        EXPECT_EQ(q.bits, p.bits);
        EXPECT_FALSE(q.reverse_x);
        EXPECT_TRUE(q.reverse_y);
        EXPECT_EQ(q.binning_x, 2);
        EXPECT_EQ(q.binning_y, 4);
        EXPECT_EQ(q.width, 640);
        EXPECT_EQ(q.height, 480);
        EXPECT_EQ(q.offset_x, 7);
        EXPECT_EQ(q.offset_y, 9);
        EXPECT_EQ(q.first_row, 100);
        EXPECT_EQ(q.rows, 20);
        EXPECT_EQ(q.pixel_code, p.pixel_code);
        EXPECT_EQ(q.frame, p.frame);
        EXPECT_EQ(q.exposure_s, 0.0125);
        EXPECT_EQ(q.segment, 3u);
        EXPECT_EQ(q.segments, 70u);
        EXPECT_EQ(q.strip_offset, 12u);
        EXPECT_EQ(q.strip_bytes, 19200u);
        EXPECT_EQ(std::vector<std::uint8_t>(q.data, q.data + q.data_bytes),
                  (std::vector<std::uint8_t>{1, 2, 3}));
    }
    // "123456789" gives 0x29B1 (docs/packets.md).
    EXPECT_EQ(detail::crc16(reinterpret_cast<const std::uint8_t*>("123456789"), 9), 0x29B1);
}

TEST(ImagePackets, WhatIsNoPacketIsRefused) {
    std::uint16_t count = 0;
    const Shape shape;
    const auto good = packets_of(random_pixels(shape, 1), shape, 1, count).front();
    const auto fault = [&](std::size_t at, std::uint8_t value, bool sealed) {
        auto bytes = good;
        bytes[at] = value;
        if (sealed) {
            bytes.resize(bytes.size() - 2);
            put(bytes, detail::crc16(bytes.data(), bytes.size()), 2);
        }
        Packet p;
        return read_packet(bytes.data(), bytes.size(), p);
    };
    Packet p;
    EXPECT_EQ(read_packet(good.data(), good.size() - 1, p), Fault::kLength);
    EXPECT_EQ(read_packet(good.data(), 69, p), Fault::kLength);
    EXPECT_EQ(read_packet(good.data(), 0, p), Fault::kLength);
    EXPECT_EQ(fault(80, static_cast<std::uint8_t>(good[80] ^ 1), false), Fault::kCrc);
    EXPECT_EQ(fault(0, 0x18, true), Fault::kPrimary);  // a telecommand
    EXPECT_EQ(fault(6, 0x1F, true), Fault::kVersion);  // another time code
    EXPECT_EQ(fault(16, 2, true), Fault::kVersion);
    EXPECT_EQ(fault(17, 6, true), Fault::kVersion);
    EXPECT_EQ(fault(18, 0, true), Fault::kGeometry);    // no bits
    EXPECT_EQ(fault(32, 1, true), Fault::kGeometry);    // 256 rows and more
    EXPECT_EQ(fault(57, 200, true), Fault::kGeometry);  // a segment beyond the last
    EXPECT_EQ(fault(66, 0, true), Fault::kNone);
    EXPECT_EQ(fault(63 - 5, 0xFF, true), Fault::kNone);  // many segments: the assembler's affair
    EXPECT_EQ(fault(62, 0xFF, true), Fault::kGeometry);  // an offset beyond the strip
}

TEST(ImagePackets, PicturesComeBackBitForBit) {
    for (const Payload payload : {Payload::kRawLittleEndian, Payload::kRawBigEndian, Payload::kPacked})
        for (const unsigned bits : {8u, 10u, 11u, 12u, 14u, 16u})
            for (const bool crc : {false, true}) {
                Shape shape;
                shape.payload = payload, shape.bits = static_cast<std::uint8_t>(bits), shape.crc = crc;
                Reader reader;
                std::uint16_t count = 0;
                for (unsigned frame = 1; frame <= 3; ++frame) {
                    const auto pixels = random_pixels(shape, frame);
                    for (const auto& packet : packets_of(pixels, shape, frame, count)) reader.take(packet);
                    ASSERT_EQ(reader.pictures.size(), frame);
                    EXPECT_EQ(reader.pictures.back().pixels, pixels);
                    EXPECT_EQ(reader.pictures.back().missing_pixels, 0u);
                    EXPECT_EQ(reader.pictures.back().header.frame, frame);
                }
                EXPECT_EQ(reader.receiver.counts().refused + reader.receiver.counts().unused, 0u);
            }
}

// A fifth lost, some doubled, neighbours exchanged: what is there is right, what is not is marked, and the
// counts are exact.
TEST(ImagePackets, WhatIsLostIsMissingAndNothingIsWrong) {
    std::mt19937 random(7);
    for (const Payload payload : {Payload::kRawBigEndian, Payload::kPacked}) {
        Shape shape;
        shape.payload = payload;
        Reader reader;
        std::uint16_t count = 0;
        std::vector<std::vector<std::uint16_t>> sent;
        std::vector<std::uint32_t> lost;
        constexpr unsigned kFrames = 200;
        for (unsigned frame = 1; frame <= kFrames; ++frame) {
            sent.push_back(random_pixels(shape, frame));
            auto packets = packets_of(sent.back(), shape, frame, count);
            lost.push_back(0);
            for (std::size_t i = 0; i + 1 < packets.size(); ++i)
                if (random() % 4 == 0) std::swap(packets[i], packets[i + 1]);
            // A frame of which nothing comes is no picture: its last packet stays.
            for (std::size_t i = 0; i < packets.size(); ++i) {
                if (random() % 5 == 0 && i + 1 < packets.size()) {
                    ++lost.back();
                    continue;
                }
                reader.take(packets[i]);
                if (random() % 10 == 0) reader.take(packets[i]);
            }
        }
        std::uint16_t last = 0;
        reader.take(packets_of(random_pixels(shape, 0), shape, kFrames + 1, last).front());
        ASSERT_EQ(reader.pictures.size(), kFrames);
        std::size_t missing_pixels = 0;
        for (unsigned i = 0; i < kFrames; ++i) {
            const Kept& p = reader.pictures[i];
            ASSERT_EQ(p.header.frame, i + 1);
            ASSERT_EQ(p.missing_packets, lost[i]);
            std::size_t missing = 0;
            for (std::size_t k = 0; k < p.pixels.size(); ++k) {
                ASSERT_EQ(p.pixels[k], p.valid[k] ? sent[i][k] : 0);
                missing += p.valid[k] ? 0u : 1u;
            }
            ASSERT_EQ(p.missing_pixels, missing);
            ASSERT_EQ(missing > 0, lost[i] > 0);
            missing_pixels += missing;
        }
        // A lost packet of 61 bytes takes 30 to 32 pixels of 16 bits, or 40 to 42 of 12.
        const double per_packet =
            static_cast<double>(missing_pixels) / std::accumulate(lost.begin(), lost.end(), 0u);
        EXPECT_GT(per_packet, payload == Payload::kPacked ? 30 : 22);
        EXPECT_LT(per_packet, payload == Payload::kPacked ? 42 : 32);
    }
}

TEST(ImagePackets, AStreamIsCutAgainAfterBytesAreLost) {
    const Shape shape;
    std::uint16_t count = 0;
    std::vector<std::uint8_t> stream{0xDE, 0xAD, 0x09};
    std::vector<std::vector<std::uint16_t>> sent;
    for (unsigned frame = 1; frame <= 4; ++frame) {
        sent.push_back(random_pixels(shape, frame));
        auto packets = packets_of(sent.back(), shape, frame, count);
        for (std::size_t i = 0; i < packets.size(); ++i) {
            // Of frame 2: a packet that lacks its end, so that its length reaches into the next one.
            const bool cut = frame == 2 && i == 4;
            stream.insert(stream.end(), packets[i].begin(), packets[i].end() - (cut ? 30 : 0));
        }
    }
    for (const std::size_t piece : {1ul, 7ul, 1000ul, stream.size()}) {
        Reader reader;
        for (std::size_t at = 0; at < stream.size(); at += piece)
            reader.receiver.take(stream.data() + at, std::min(piece, stream.size() - at), keep,
                                 &reader.pictures);
        ASSERT_EQ(reader.pictures.size(), 4u);
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_EQ(reader.pictures[i].missing_packets, i == 1 ? 1u : 0u) << piece;
            if (i != 1) {
                EXPECT_EQ(reader.pictures[i].pixels, sent[i]);
            }
        }
        EXPECT_GT(reader.receiver.counts().skipped_bytes, 3u);
    }
}

TEST(ImagePackets, ACompressedStripGoesToItsDecoderWhenAllOfItIsThere) {
    Shape shape;
    shape.payload = Payload::kRawBigEndian;
    std::uint16_t count = 0;
    const auto pixels = random_pixels(shape, 5);
    auto packets = packets_of(pixels, shape, 1, count);
    for (auto& bytes : packets) {  // the same bytes under another name
        bytes[17] = static_cast<std::uint8_t>(Payload::kJpegLs);
        bytes.resize(bytes.size() - 2);
        put(bytes, detail::crc16(bytes.data(), bytes.size()), 2);
    }
    int decoded = 0;
    const StripDecoder decoder = [](void* context, const Packet& head, const std::uint8_t* bytes,
                                    std::size_t size, std::uint16_t* out) {
        ++*static_cast<int*>(context);
        if (head.first_row == 10) return false;
        for (std::size_t i = 0; i < size / 2; ++i)
            out[i] = static_cast<std::uint16_t>(bytes[2 * i] << 8 | bytes[2 * i + 1]);
        return size == 2 * std::size_t{head.rows} * head.width;
    };
    PictureReceiver receiver(0x110, 64 * 64, decoder, &decoded);
    std::vector<Kept> pictures;
    for (std::size_t i = 1; i < packets.size(); ++i)
        receiver.take(packets[i].data(), packets[i].size(), keep, &pictures);
    const auto next = packets_of(pixels, shape, 2, count).front();
    receiver.take(next.data(), next.size(), keep, &pictures);
    ASSERT_EQ(pictures.size(), 1u);
    EXPECT_EQ(decoded, 4);  // of five strips, the first lacks a packet
    for (std::size_t k = 0; k < pixels.size(); ++k) {
        const std::size_t row = k / shape.width;
        const bool there = row >= 5 && (row < 10 || row >= 15);
        EXPECT_EQ(pictures[0].pixels[k], there ? pixels[k] : 0);
    }
    EXPECT_EQ(pictures[0].missing_pixels, 10u * shape.width);
}

TEST(ImagePackets, FramesThatDoNotFitAreNotTaken) {
    Shape big;
    big.width = 65, big.height = 64;
    std::uint16_t count = 0;
    Reader reader;
    for (const auto& packet : packets_of(random_pixels(big, 1), big, 1, count)) reader.take(packet);
    EXPECT_TRUE(reader.pictures.empty());
    EXPECT_EQ(reader.receiver.counts().unused, count);
    // A packet with another geometry inside a frame.
    const Shape shape;
    Shape other = shape;
    other.strip_rows = 7;
    const auto pixels = random_pixels(shape, 2);
    const auto packets = packets_of(pixels, shape, 2, count), strange = packets_of(pixels, other, 2, count);
    const std::uint64_t before = reader.receiver.counts().unused;
    for (std::size_t i = 0; i < packets.size(); ++i) {
        reader.take(packets[i]);
        if (i == 20) reader.take(strange[10]);
    }
    ASSERT_EQ(reader.pictures.size(), 1u);
    EXPECT_EQ(reader.pictures[0].pixels, pixels);
    EXPECT_EQ(reader.receiver.counts().unused, before + 1);
}

TEST(ImagePackets, ASenderMayBeginAnew) {
    const Shape shape;
    Reader reader;
    for (int run = 0; run < 2; ++run) {
        std::uint16_t count = 0;
        for (unsigned frame = 1; frame <= 5; ++frame)
            for (const auto& packet : packets_of(random_pixels(shape, frame), shape, frame, count))
                reader.take(packet);
    }
    // 32 packets a frame: two frames but for a packet are taken for late ones.
    ASSERT_EQ(reader.pictures.size(), 9u);
    EXPECT_EQ(reader.pictures[5].header.frame, 2u);
    EXPECT_EQ(reader.pictures[5].missing_packets, 31u);
    EXPECT_EQ(reader.pictures[8].pixels, random_pixels(shape, 5));
}

}  // namespace
}  // namespace hilcam_image
