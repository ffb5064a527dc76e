#include "io/system/crc32.h"

#include <zlib.h>

namespace hilcam {

std::uint32_t crc32_of(std::span<const std::uint8_t> bytes, std::uint32_t before) {
    // zlib takes a null pointer for the wish to begin anew, and an empty span may have one.
    if (bytes.empty()) return before;
    return static_cast<std::uint32_t>(::crc32_z(before, bytes.data(), bytes.size()));
}

}  // namespace hilcam
