#include "io/system/crc32.h"

#include <zlib.h>

namespace hilcam {

std::uint32_t crc32_of(std::span<const std::uint8_t> bytes, std::uint32_t before) {
    // zlib starts anew when it gets a null pointer, which an empty span may have.
    if (bytes.empty()) return before;
    return static_cast<std::uint32_t>(::crc32_z(before, bytes.data(), bytes.size()));
}

}  // namespace hilcam
