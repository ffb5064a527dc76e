#pragma once
// A dialect is the headers and checks around commands, acknowledgements and telemetry: hilcam's own, or those
// of NASA's core Flight System. The contents are the same. Pure functions over bytes.

#include <cstdint>
#include <span>

#include "io/commands/command_codec.h"
#include "io/commands/packet_stream.h"
#include "io/commands/telemetry_codec.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

enum class Dialect : std::uint8_t { kHilcam, kCfs };
enum class ChecksumRule : std::uint8_t { kRequired, kOptional };

struct DialectConfig {
    Dialect dialect = Dialect::kHilcam;
    ChecksumRule checksum = ChecksumRule::kRequired;  // cFS only
};
// Adds the dialect's keys to a transport's own.
void add_fields(DialectConfig& dialect, Fields& fields);
void validate(const DialectConfig& dialect);

// The longest packet of any kind, in either dialect.
inline constexpr std::size_t kMaxPacketBytes = 256;

DecodedCommand decode_command(std::span<const std::uint8_t> packet, const DialectConfig& dialect);
std::size_t encode_command(const Command& command, std::uint32_t sequence, const DialectConfig& dialect,
                           std::span<std::uint8_t> bytes, std::uint16_t camera = 0);
std::size_t encode_acknowledgement(const Acknowledgement& acknowledgement, std::uint16_t count,
                                   const DialectConfig& dialect, std::span<std::uint8_t> bytes);
bool decode_acknowledgement(std::span<const std::uint8_t> packet, const DialectConfig& dialect,
                            Acknowledgement& acknowledgement);
std::size_t encode_telemetry(const Telemetry& telemetry, std::uint16_t count, const DialectConfig& dialect,
                             std::span<std::uint8_t> bytes);
bool decode_telemetry(std::span<const std::uint8_t> packet, const DialectConfig& dialect,
                      Telemetry& telemetry);

// Return the rules for packets from senders, and for packets to them.
PacketRule command_rule(const DialectConfig& dialect);
PacketRule answer_rule(const DialectConfig& dialect);
// Returns the number of bits of a sequence number in a packet.
int sequence_bits(const DialectConfig& dialect);

}  // namespace hilcam
