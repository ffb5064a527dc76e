#pragma once
// CRC-32 (ISO 3309, as in zlib).

#include <cstdint>
#include <span>

namespace hilcam {

// The checksum of bytes that follow those which gave `before`.
std::uint32_t crc32_of(std::span<const std::uint8_t> bytes, std::uint32_t before = 0);

}  // namespace hilcam
