#pragma once
// The protocol in the dialect of NASA's core Flight System: cFE command and telemetry headers around the same
// payloads and bodies. Pure functions over bytes.
//
// A command (MsgId 0x1900: 0x1800 | APID 0x100) has a secondary header of two bytes, function code and
// checksum. The checksum is such that the exclusive or of 0xFF and all bytes is 0 (cFE, modules/msg,
// cfe_msg_sechdr_checksum.c). Telemetry (MsgId 0x0800 | APID) has six bytes of time, seconds (u32) and 2^-16
// s (u16) since 1980-01-01T00:00:00 TAI, cFE's default epoch, and four spare ones (CFE_MSG_TelemetryHeader_t
// of cFE 7). Not modelled: cFE's payloads in the byte order of a little-endian machine; ours are big-endian.

#include <cstdint>
#include <span>

#include "io/commands/command_codec.h"
#include "io/commands/telemetry_codec.h"

namespace hilcam {

// Decodes a packet. Ground tools of cFS often leave the checksum 0, so it is verified only if required. The
// sequence number is the primary header's 14-bit count.
DecodedCommand decode_cfs_command(std::span<const std::uint8_t> packet, bool checksum_required);
// Returns the number of bytes written.
std::size_t encode_cfs_command(const Command& command, std::uint32_t sequence, std::span<std::uint8_t> bytes);

std::size_t encode_cfs_acknowledgement(const Acknowledgement& acknowledgement, std::uint16_t count,
                                       std::span<std::uint8_t> bytes);
bool decode_cfs_acknowledgement(std::span<const std::uint8_t> packet, Acknowledgement& acknowledgement);
std::size_t encode_cfs_telemetry(const Telemetry& telemetry, std::uint16_t count,
                                 std::span<std::uint8_t> bytes);
bool decode_cfs_telemetry(std::span<const std::uint8_t> packet, Telemetry& telemetry);

// Returns the checksum over a packet; 0 when it includes its correct checksum.
std::uint8_t cfs_checksum(std::span<const std::uint8_t> packet);

}  // namespace hilcam
