#pragma once
// CCSDS Space Packets (133.0-B-2): the 6-byte primary header and a CRC over the whole packet. Pure functions
// over bytes.

#include <cstdint>
#include <span>

namespace hilcam {

struct SpacePacketHeader {
    static constexpr std::size_t kBytes = 6;

    std::uint8_t version = 0;  // 3 bits, 0
    bool command = false;      // packet type: 1 telecommand, 0 telemetry
    bool secondary_header = true;
    std::uint16_t apid = 0;           // 11 bits
    std::uint8_t sequence_flags = 3;  // 3: unsegmented
    std::uint16_t count = 0;          // 14 bits
    std::uint16_t data_length = 0;    // bytes after the primary header, minus 1

    std::size_t total_bytes() const { return kBytes + std::size_t{data_length} + 1; }
};

// bytes: at least kBytes.
SpacePacketHeader read_packet_header(std::span<const std::uint8_t> bytes);
void write_packet_header(const SpacePacketHeader& header, std::span<std::uint8_t> bytes);

// Version of hilcam's own secondary headers, their first byte.
inline constexpr std::uint8_t kProtocolVersion = 1;
inline constexpr std::size_t kCrcBytes = 2;

// CRC-16/CCITT-FALSE: polynomial 0x1021, initial 0xFFFF, not reflected (CCSDS 132.0-B-3, 4.1.6.2).
// "123456789" gives 0x29B1. The CRC of a packet that ends with its own CRC is 0.
std::uint16_t crc16(std::span<const std::uint8_t> bytes);

// Puts header and CRC around a body of `body_bytes`, which is already behind the header's place, and sets
// data_length. Returns the packet's length.
std::size_t seal_packet(SpacePacketHeader header, std::size_t body_bytes, std::span<std::uint8_t> bytes);

}  // namespace hilcam
