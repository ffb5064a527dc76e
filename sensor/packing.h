#pragma once
// Pixels in a camera's memory, as its wire or file has them.
//
//   none    one byte each where container_bits is 8, else two, least significant first
//   pfnc    bit after bit without a gap, least significant first: Mono10p, Mono12p, ... (EMVA, GenICam Pixel
//           Format Naming Convention 2.4, 2019)
//   gige    two pixels in three bytes: the upper eight bits of each, their lower bits between (Mono10Packed,
//           Mono12Packed of GigE Vision 1.2)

#include <cstddef>
#include <cstdint>
#include <span>

namespace hilcam {

enum class Packing { kNone, kPfnc, kGige };

struct PixelLayout {
    Packing packing = Packing::kNone;
    int bits = 12;            // significant, of a pixel
    int container_bits = 16;  // without packing: 8 or 16
};

// Bytes of so many pixels; a last one that is not full counts.
std::size_t packed_bytes(std::size_t pixels, const PixelLayout& layout);
// Values above `bits` must not occur. out: packed_bytes() long. Any thread, no allocation.
void pack(std::span<const std::uint16_t> dn, const PixelLayout& layout, std::span<std::uint8_t> out);

}  // namespace hilcam
