#pragma once
// Unit vectors in few bits.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "render/vocabulary/vec.h"

namespace hilcam {

// Packs a unit vector into 32 bits, octahedral with 16 bits per axis: largest error 0.0037 deg (Cigolle et
// al., JCGT 3(2), 2014).
std::uint32_t pack_normal(Vec3f unit);
// Returns its direction, with a length of 0.57 to 1.
inline Vec3f unpack_long_normal(std::uint32_t packed) {
    const auto from_snorm16 = [](std::uint32_t bits) {
        return static_cast<float>(static_cast<std::int16_t>(static_cast<std::uint16_t>(bits))) *
               (1.0f / 32767.0f);
    };
    float x = from_snorm16(packed & 0xFFFFu);
    float y = from_snorm16(packed >> 16);
    const float z = 1 - std::abs(x) - std::abs(y);
    // Unfolds the lower half without a branch.
    const float t = std::max(-z, 0.0f);
    x += x >= 0 ? -t : t;
    y += y >= 0 ? -t : t;
    return {x, y, z};
}
inline Vec3f unpack_normal(std::uint32_t packed) { return normalized(unpack_long_normal(packed)); }

}  // namespace hilcam
