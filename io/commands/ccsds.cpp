#include "io/commands/ccsds.h"

#include <array>

#include "io/system/bytes.h"

namespace hilcam {
namespace {

constexpr std::array<std::uint16_t, 256> make_crc_table() {
    std::array<std::uint16_t, 256> table{};
    for (unsigned i = 0; i < 256; ++i) {
        unsigned value = i << 8;
        for (int bit = 0; bit < 8; ++bit) value = value & 0x8000u ? (value << 1) ^ 0x1021u : value << 1;
        table[i] = static_cast<std::uint16_t>(value);
    }
    return table;
}
constexpr std::array<std::uint16_t, 256> kCrcTable = make_crc_table();

}  // namespace

SpacePacketHeader read_packet_header(std::span<const std::uint8_t> bytes) {
    ByteReader in(bytes);
    const unsigned identification = in.u16();
    const unsigned sequence = in.u16();
    SpacePacketHeader header;
    header.version = static_cast<std::uint8_t>(identification >> 13);
    header.command = identification >> 12 & 1;
    header.secondary_header = identification >> 11 & 1;
    header.apid = static_cast<std::uint16_t>(identification & 0x7FF);
    header.sequence_flags = static_cast<std::uint8_t>(sequence >> 14);
    header.count = static_cast<std::uint16_t>(sequence & 0x3FFF);
    header.data_length = in.u16();
    return header;
}

void write_packet_header(const SpacePacketHeader& h, std::span<std::uint8_t> bytes) {
    ByteWriter(bytes)
        .u16(unsigned{h.version} << 13 | (h.command ? 1u << 12 : 0) | (h.secondary_header ? 1u << 11 : 0) |
             h.apid)
        .u16(unsigned{h.sequence_flags} << 14 | h.count)
        .u16(h.data_length);
}

std::uint16_t crc16(std::span<const std::uint8_t> bytes) {
    unsigned crc = 0xFFFF;
    for (const std::uint8_t byte : bytes) crc = (crc << 8 & 0xFFFF) ^ kCrcTable[crc >> 8 ^ byte];
    return static_cast<std::uint16_t>(crc);
}

std::size_t seal_packet(SpacePacketHeader header, std::size_t body_bytes, std::span<std::uint8_t> bytes) {
    const std::size_t covered = SpacePacketHeader::kBytes + body_bytes;
    header.count &= 0x3FFF;
    header.data_length = static_cast<std::uint16_t>(body_bytes + kCrcBytes - 1);
    write_packet_header(header, bytes);
    ByteWriter(bytes.subspan(covered)).u16(crc16(bytes.first(covered)));
    return covered + kCrcBytes;
}

}  // namespace hilcam
