#include "sensor/packing.h"

#include <algorithm>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

std::uint8_t low_byte(std::uint32_t value) { return static_cast<std::uint8_t>(value & 0xFFu); }

void pack_plain(std::span<const std::uint16_t> dn, int container_bits, std::span<std::uint8_t> out) {
    for (std::size_t i = 0; i < dn.size(); ++i) {
        if (container_bits == 8) {
            out[i] = low_byte(dn[i]);
            continue;
        }
        out[2 * i] = low_byte(dn[i]);
        out[2 * i + 1] = low_byte(std::uint32_t{dn[i]} >> 8);
    }
}

void pack_stream(std::span<const std::uint16_t> dn, int bits, std::span<std::uint8_t> out) {
    std::uint32_t waiting = 0;  // bits that are not yet written, the first one lowest
    int count = 0;
    std::size_t at = 0;
    for (const std::uint16_t value : dn) {
        waiting |= std::uint32_t{value} << count;
        for (count += bits; count >= 8; count -= 8, waiting >>= 8) out[at++] = low_byte(waiting);
    }
    if (count > 0) out[at] = low_byte(waiting);
}

void pack_pairs(std::span<const std::uint16_t> dn, int bits, std::span<std::uint8_t> out) {
    const int low_bits = bits - 8;
    const std::uint32_t low = (1u << low_bits) - 1;
    for (std::size_t i = 0; i < dn.size(); i += 2) {
        const std::uint32_t first = dn[i], second = i + 1 < dn.size() ? dn[i + 1] : 0u;
        const std::size_t at = i / 2 * 3;
        out[at] = low_byte(first >> low_bits);
        out[at + 1] = low_byte((first & low) | (second & low) << 4);
        if (at + 2 < out.size()) out[at + 2] = low_byte(second >> low_bits);
    }
}

}  // namespace

std::size_t packed_bytes(std::size_t pixels, const PixelLayout& layout) {
    if (layout.packing == Packing::kNone) return pixels * static_cast<std::size_t>(layout.container_bits / 8);
    if (layout.packing == Packing::kGige) return (pixels * 3 + 1) / 2;
    return (pixels * static_cast<std::size_t>(layout.bits) + 7) / 8;
}

void pack(std::span<const std::uint16_t> dn, const PixelLayout& layout, std::span<std::uint8_t> out) {
    HILCAM_CHECK(out.size() == packed_bytes(dn.size(), layout));
    if (layout.packing == Packing::kNone) return pack_plain(dn, layout.container_bits, out);
    if (layout.packing == Packing::kGige) return pack_pairs(dn, layout.bits, out);
    pack_stream(dn, layout.bits, out);
}

}  // namespace hilcam
