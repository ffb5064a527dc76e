#pragma once
// Acknowledgements, the answers to command packets. Their body is the same in all dialects; the Space Packet
// around it here is hilcam's own. Pure functions over bytes.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "io/contract/command.h"
#include "io/system/bytes.h"

namespace hilcam {

inline constexpr std::uint16_t kAcknowledgeApid = 0x101;
inline constexpr std::size_t kMaxAcknowledgeBytes = 192;

struct Acknowledgement {
    std::uint8_t function = 0;
    CommandStatus status = CommandStatus::kAccepted;
    std::uint32_t sequence = 0;
    std::uint64_t token = 0;  // token of a ping; sender_ns of a clock command
    TimeTai simulated_time;
    std::string reason;  // at most 96 bytes of it are sent
    // Clock reading, for an accepted clock command. simulated_time equals `departure`; the packet has it
    // once, as simulated_time.
    std::optional<ClockReading> clock{};
};

// Returns the number of bytes written. count: the primary header's 14-bit counter.
std::size_t encode_acknowledgement(const Acknowledgement& acknowledgement, std::uint16_t count,
                                   std::span<std::uint8_t> bytes);
// Returns false when the bytes are no acknowledgement.
bool decode_acknowledgement(std::span<const std::uint8_t> packet, Acknowledgement& acknowledgement);

// Writes everything from the protocol version on, except the check at the end.
void write_acknowledgement_body(const Acknowledgement& acknowledgement, ByteWriter& out);
bool read_acknowledgement_body(std::span<const std::uint8_t> body, Acknowledgement& acknowledgement);

// Returns "accepted", "bad checksum", ...
std::string_view name_of(CommandStatus status);
// Returns the name of the status and, after a colon, the reason, made safe for a terminal because the peer
// wrote it.
std::string text_of(const Acknowledgement& a);
// Returns a line that explains the status: the reason given when a well-formed command is refused.
std::string_view meaning_of(CommandStatus status);
// Returns the same for a certain command, with what helps.
std::string_view meaning_of(CommandStatus status, const Command& command);

}  // namespace hilcam
