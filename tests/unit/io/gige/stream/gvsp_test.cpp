#include "io/gige/stream/gvsp.h"

#include <gmock/gmock.h>

#include <functional>
#include <string>
#include <vector>

namespace hilcam::gvsp {
namespace {

// "00 01 | ab" -> bytes.
std::vector<std::uint8_t> bytes(const std::string& hex) {
    std::vector<std::uint8_t> out;
    std::string digits;
    for (const char c : hex)
        if (std::isxdigit(static_cast<unsigned char>(c))) digits += c;
    for (std::size_t i = 0; i < digits.size(); i += 2)
        out.push_back(static_cast<std::uint8_t>(std::stoi(digits.substr(i, 2), nullptr, 16)));
    return out;
}

// Written by hand from the layouts in Wireshark's packet-gvsp.c (2.x) and Aravis' arvgvspprivate.h.
TEST(Gvsp, EveryPacketHasTheStandardsBytes) {
    const PacketHeader plain{.block = 0x1234, .packet = 0x00ABCD};
    const PacketHeader longer{.extended = true, .block = 0x123456789ABCDEF0, .packet = 0x89ABCDEF};
    const auto with = [](PacketHeader h, Format f, Status s = kFresh) {
        h.format = f, h.status = s;
        return h;
    };
    const Image image{0x01100005, 640, 480, 16, 32};
    const ChunkTail chunks{0x00012345, 0x00000042};
    const std::vector<Part> parts = {{Part::k2dImage, 0x123456789A, image}, {Part::kChunkData, 40, {}}};
    using Out = std::span<std::uint8_t>;
    struct Row {
        const char* name;
        std::function<std::size_t(Out)> write;
        const char* expected;
    };
    const std::vector<Row> rows = {
        {"short payload", [&](Out o) { return write_header(plain, o); }, "0000 1234 03 00ABCD"},
        {"short, resent", [&](Out o) { return write_header(with(plain, kPayload, kResent), o); },
         "0100 1234 03 00ABCD"},
        {"extended payload", [&](Out o) { return write_header(longer, o); },
         "0000 0000 83 000000 123456789ABCDEF0 89ABCDEF"},
        {"extended, resent: the flag too",
         [&](Out o) { return write_header(with(longer, kPayload, kResent), o); },
         "0100 0001 83 000000 123456789ABCDEF0 89ABCDEF"},
        {"unavailable", [&](Out o) { return write_header(with(plain, kPayload, kUnavailable), o); },
         "800C 1234 03 00ABCD"},
        {"removed with all before",
         [&](Out o) { return write_header(with(longer, kPayload, kRemovedWithAllBefore), o); },
         "8011 0000 83 000000 123456789ABCDEF0 89ABCDEF"},
        {"removed", [&](Out o) { return write_header(with(plain, kPayload, kRemoved), o); },
         "8012 1234 03 00ABCD"},
        {"not yet available", [&](Out o) { return write_header(with(plain, kPayload, kNotYetAvailable), o); },
         "8010 1234 03 00ABCD"},
        {"leader",
         [&](Out o) { return write_image_leader(with(plain, kLeader), false, 0x0102030405060708, image, o); },
         "0000 1234 01 00ABCD 0000 0001 0102030405060708"
         "01100005 00000280 000001E0 00000010 00000020 0000 0000"},
        {"leader of an image with chunks",
         [&](Out o) { return write_image_leader(with(longer, kLeader), true, 5, image, o); },
         "0000 0000 81 000000 123456789ABCDEF0 89ABCDEF 0000 4001 0000000000000005"
         "01100005 00000280 000001E0 00000010 00000020 0000 0000"},
        {"trailer", [&](Out o) { return write_trailer(with(plain, kTrailer), kImage, 480, nullptr, o); },
         "0000 1234 02 00ABCD 0000 0001 000001E0"},
        {"trailer of an image with chunks",
         [&](Out o) { return write_trailer(with(longer, kTrailer), kImage, 480, &chunks, o); },
         "0000 0000 82 000000 123456789ABCDEF0 89ABCDEF 0000 4001 000001E0 00012345 00000042"},
        {"multipart leader",
         [&](Out o) { return write_multipart_leader(with(longer, kLeader), true, 5, parts, o); },
         "0000 0000 81 000002 123456789ABCDEF0 89ABCDEF 0000 400A 0000000000000005"
         "0001 0012 3456789A 01100005 0000 00 00 00000000 0000 0000"
         "00000280 000001E0 00000010 00000020 0000 0000 00000000"
         "000A 0000 00000028 00000000 0000 00 00 00000000 0000 0000"
         "00000000 00000000 00000000 00000000 0000 0000 00000000"},
        {"multipart payload",
         [&](Out o) { return write_part_payload(with(longer, kMultipart), 1, 0x123456789A, o); },
         "0000 0000 87 000000 123456789ABCDEF0 89ABCDEF 01 00 0012 3456789A"},
        {"multipart trailer",
         [&](Out o) { return write_trailer(with(longer, kTrailer), kMultipartPayload, 480, nullptr, o); },
         "0000 0000 82 000000 123456789ABCDEF0 89ABCDEF 0000 000A 000001E0"},
        {"multipart trailer with chunks",
         [&](Out o) { return write_trailer(with(longer, kTrailer), kMultipartPayload, 480, &chunks, o); },
         "0000 0000 82 000000 123456789ABCDEF0 89ABCDEF 0000 400A 000001E0 00012345 00000042"},
    };
    for (const Row& row : rows) {
        std::vector<std::uint8_t> out(kMaxHeadBytes + 1, 0xEE);
        const std::size_t size = row.write(std::span(out).first(kMaxHeadBytes));
        ASSERT_LE(size, kMaxHeadBytes) << row.name;
        EXPECT_EQ(out[size], 0xEE) << row.name;
        out.resize(size);
        EXPECT_EQ(out, bytes(row.expected)) << row.name;
    }
}

TEST(Gvsp, APacketIdCanBeWrittenOver) {
    for (const bool extended : {false, true}) {
        PacketHeader header{.extended = extended, .block = 7, .packet = 1};
        std::vector<std::uint8_t> out(kMaxHeadBytes), expected(kMaxHeadBytes);
        write_header(header, out);
        overwrite_packet_id(out, extended, 0x123456);
        header.packet = 0x123456;
        write_header(header, expected);
        EXPECT_EQ(out, expected);
    }
}

TEST(Gvsp, PacketSizesCountTheHeadersBelow) {
    EXPECT_EQ(overhead_bytes(false), 36u);
    EXPECT_EQ(overhead_bytes(true), 48u);
}

}  // namespace
}  // namespace hilcam::gvsp
