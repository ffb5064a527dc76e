#pragma once
// CRC-32 (ISO 3309, as in zlib).

#include <cstdint>
#include <span>

namespace hilcam {

// Returns the checksum of `bytes`, continued from `before`, the checksum of the bytes in front of them.
std::uint32_t crc32_of(std::span<const std::uint8_t> bytes, std::uint32_t before = 0);

}  // namespace hilcam
