#pragma once
// The secondary header of an image packet, which follows the primary header of CCSDS 133.0-B-2: a time code,
// then what a receiver needs to place the packet's pixels if all other packets are lost. image_packet.json
// and docs/packets.md have the same table. Numbers are big-endian. Pure functions over bytes.

#include <cstdint>
#include <span>

#include "io/packets/payload.h"
#include "render/vocabulary/time.h"

namespace hilcam {

// The fields that all packets of a frame have in common.
struct ImageFrame {
    TimeTai exposure_mid;  // simulated
    Payload payload = Payload::kRawLittleEndian;
    std::uint8_t bits = 0;  // significant bits of a DN
    bool reverse_x = false, reverse_y = false;
    bool crc = false;  // the packet ends with a CRC-16
    std::uint8_t binning_x = 1, binning_y = 1;
    std::uint16_t width = 0, height = 0;       // the frame's size, px
    std::uint16_t offset_x = 0, offset_y = 0;  // the window's first pixel on the sensor, unbinned px
    std::uint32_t pixel_code = 0;              // pixel_code.h
    std::uint64_t frame = 0;                   // its id: 1, 2, 3, ...
    double exposure_s = 0;
};
// The place of a packet's data in the frame.
struct ImageSegment {
    std::uint16_t first_row = 0, rows = 0;  // the strip that the data are a part of
    std::uint32_t segment = 0;              // number of the packet in the frame, from 0
    std::uint32_t segments = 0;             // packets of the frame
    std::uint32_t strip_offset = 0;         // place of the data's first byte in the strip's payload
    std::uint32_t strip_bytes = 0;          // size of the strip's whole payload
};

inline constexpr std::uint8_t kImageHeaderVersion = 1;
inline constexpr std::size_t kImageHeaderBytes = 64;

// bytes: at least kImageHeaderBytes. Any thread; no allocation.
void write_image_header(const ImageFrame& frame, const ImageSegment& segment, std::span<std::uint8_t> bytes);

}  // namespace hilcam
