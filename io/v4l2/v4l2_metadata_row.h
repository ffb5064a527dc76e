#pragma once
// One more row of the picture holds the metadata of a frame: readers of a V4L2 device get no other metadata
// (v4l2loopback 0.12.7 does not even count frames in mmap mode).
//
// The row's first 80 bytes, big-endian as all of hilcam's protocols; the rest is 0:
//
//      0  4 bytes  "HCMR"
//      4  u16      layout's version, 1
//      6  u16      80, its length with the CRC
//      8  u64      frame id
//     16  i64      middle of the exposure, simulated TAI [ns since 1970]
//     24  i64      the same instant on this machine's CLOCK_MONOTONIC [ns]; 0: none
//     32  f64      exposure time [s]
//     40  f64      gain [dB]
//     48  u32      sequence number of the newest pose that the frame shows
//     52  u32      sequence number of the `expose` that asked for it; 0: none
//     56  i64      that pose's time tag, TAI [ns]
//     64  u64      faults that strike it (bit_of() in io/contract/fault.h)
//     72  u32      quality level; 0: as configured
//     76  u16      significant bits of a DN
//     78  u16      CRC-16/CCITT-FALSE of bytes 0 to 77
//
// docs/devices.md shows a reader in Python.

#include <optional>
#include <span>

#include "io/contract/frame_sink.h"

namespace hilcam {

inline constexpr std::size_t kMetadataBytes = 80;

// `row` holds at least kMetadataBytes. Any thread; no allocation.
void write_metadata_row(const FrameRecord& record, std::span<std::uint8_t> row);
// Nothing when the row is too short or not one, or its CRC is wrong.
std::optional<FrameRecord> read_metadata_row(std::span<const std::uint8_t> row);

}  // namespace hilcam
