#pragma once
// An additional picture row with a frame's metadata, because readers of a V4L2 device get no other metadata
// (v4l2loopback 0.12.7 does not even count frames in mmap mode).
//
// The row's first 80 bytes are big-endian, as in all of hilcam's protocols; the rest is 0:
//
//     0  4 bytes  "HCMR"
//     4  u16      version of the layout, 1
//     6  u16      80, its length with the CRC
//     8  u64      frame id
//    16  i64      middle of the exposure, simulated TAI [ns since 1970]
//    24  i64      the same instant on this machine's CLOCK_MONOTONIC [ns]; 0: none
//    32  f64      exposure time [s]
//    40  f64      gain [dB]
//    48  u32      sequence number of the newest pose that the frame shows
//    52  u32      sequence number of the `expose` that asked for it; 0: none
//    56  i64      that pose's time tag, TAI [ns]
//    64  u64      faults that strike it (bit_of() in io/contract/fault_kinds.h)
//    72  u32      quality level; 0: as configured
//    76  u16      significant bits of a DN
//    78  u16      CRC-16/CCITT-FALSE of bytes 0 to 77
//
// docs/devices.md shows a reader in Python.

#include <optional>
#include <span>

#include "io/contract/frame_sink.h"

namespace hilcam {

inline constexpr std::size_t kMetadataBytes = 80;

// row: at least kMetadataBytes. Any thread; no allocation.
void write_metadata_row(const FrameRecord& record, std::span<std::uint8_t> row);
// Returns nothing when the row is too short, is no metadata row, or has a wrong CRC.
std::optional<FrameRecord> read_metadata_row(std::span<const std::uint8_t> row);

}  // namespace hilcam
