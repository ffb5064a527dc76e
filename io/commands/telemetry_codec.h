#pragma once
// The bytes of telemetry (telemetry_records.h), as in docs/protocol.md. Pure functions over bytes.

#include <cstdint>
#include <span>

#include "io/commands/ccsds.h"
#include "io/contract/telemetry_records.h"
#include "io/system/bytes.h"

namespace hilcam {

inline constexpr std::uint16_t kFrameReportApid = 0x102;
inline constexpr std::uint16_t kHousekeepingApid = 0x103;

std::uint16_t apid_of(const Telemetry& telemetry);
// Returns the simulated time of its contents.
TimeTai time_of(const Telemetry& telemetry);

// Returns the number of bytes written. count: the primary header's 14-bit counter, one for each APID.
std::size_t encode_telemetry(const Telemetry& telemetry, std::uint16_t count, std::span<std::uint8_t> bytes);
// Returns false when the bytes are no telemetry packet.
bool decode_telemetry(std::span<const std::uint8_t> packet, Telemetry& telemetry);

// Writes everything from the protocol version on, except the check at the end.
void write_telemetry_body(const Telemetry& telemetry, ByteWriter& out);
bool read_telemetry_body(std::span<const std::uint8_t> body, Telemetry& telemetry);

}  // namespace hilcam
