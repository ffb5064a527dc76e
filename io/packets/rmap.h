#pragma once
// The write command of the Remote Memory Access Protocol (RMAP, ECSS-E-ST-50-52C, 5.3). Pure functions over
// bytes.

#include <cstdint>
#include <span>
#include <vector>

namespace hilcam {

// A write command without verification and without a reply: its sender does not wait.
struct RmapWrite {
    std::uint8_t target = 0xFE;  // target logical address; 0xFE: any
    std::uint8_t key = 0;
    std::uint8_t initiator = 0xFE;  // initiator logical address
    std::uint16_t transaction = 0;
    std::uint8_t extended_address = 0;
    std::uint32_t address = 0;
    bool increment = true;  // false: all bytes go to one address, a FIFO
};

inline constexpr std::size_t kRmapWriteHeaderBytes = 16;
inline constexpr std::size_t kRmapMostDataBytes = 0xFFFFFF;

// CRC-8 of headers and data: x^8 + x^2 + x + 1, least significant bit first, initial 0 (ECSS-E-ST-50-52C,
// 5.2 and annex A). The CRC of bytes that end with their own CRC is 0.
std::uint8_t rmap_crc(std::span<const std::uint8_t> bytes);

// Appends header, header CRC, data and data CRC. data: at most kRmapMostDataBytes.
void append_rmap_write(const RmapWrite& write, std::span<const std::uint8_t> data,
                       std::vector<std::uint8_t>& out);

}  // namespace hilcam
