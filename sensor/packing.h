#pragma once
// Pixels as a camera's memory, wire or file stores them.
//
//   none    one byte each with container_bits 8, else two, least significant first
//   pfnc    bit after bit without a gap, least significant first: Mono10p, Mono12p, ... (EMVA, GenICam Pixel
//           Format Naming Convention 2.4, 2019)
//   gige    two pixels in three bytes: the upper eight bits of each, with their lower bits between
//           (Mono10Packed, Mono12Packed of GigE Vision 1.2)

#include <cstddef>
#include <cstdint>
#include <span>

namespace hilcam {

enum class Packing { kNone, kPfnc, kGige };

struct PixelLayout {
    Packing packing = Packing::kNone;
    int bits = 12;            // significant bits of a pixel
    int container_bits = 16;  // without packing: 8 or 16
};

// Returns the number of bytes for the pixels, counting an incomplete last byte.
std::size_t packed_bytes(std::size_t pixels, const PixelLayout& layout);
// dn: values of at most `bits` bits. out: packed_bytes() long. Any thread, no allocation.
void pack(std::span<const std::uint16_t> dn, const PixelLayout& layout, std::span<std::uint8_t> out);

}  // namespace hilcam
