#pragma once
// Commands and acknowledgements as Space Packets, byte by byte as docs/protocol.md has them. Pure functions
// over bytes.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "io/ccsds.h"
#include "io/command.h"

namespace hilcam {

inline constexpr std::uint16_t kCommandApid = 0x100;
inline constexpr std::uint16_t kAcknowledgeApid = 0x101;
inline constexpr std::uint8_t kProtocolVersion = 1;
inline constexpr std::size_t kMostCommandBytes = 256;
inline constexpr std::size_t kMostAcknowledgeBytes = 160;

// What a packet says, or why it is refused. Header fields are filled as far as they could be read.
struct DecodedCommand {
    CommandStatus status = CommandStatus::kAccepted;
    std::string_view reason;  // of a refusal; static text
    Command command;
    SpacePacketHeader header;
    std::uint8_t function = 0;
    std::uint32_t sequence = 0;
};

// Exactly one packet (its length already taken from the header).
DecodedCommand decode_command(std::span<const std::uint8_t> packet);
// Gives the number of bytes written. `count` is the primary header's 14-bit counter.
std::size_t encode_command(const Command& command, std::uint32_t sequence, std::span<std::uint8_t> bytes);

struct Acknowledgement {
    std::uint8_t function = 0;
    CommandStatus status = CommandStatus::kAccepted;
    std::uint32_t sequence = 0;
    std::uint64_t token = 0;  // of a ping
    TimeTai simulated_time;
    std::string reason;
};
std::size_t encode_acknowledgement(const Acknowledgement& acknowledgement, std::uint16_t count,
                                   std::span<std::uint8_t> bytes);
// False when the bytes are no acknowledgement.
bool decode_acknowledgement(std::span<const std::uint8_t> packet, Acknowledgement& acknowledgement);

// "accepted", "bad checksum", ...
std::string_view name_of(CommandStatus status);

}  // namespace hilcam
