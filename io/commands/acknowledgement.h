#pragma once
// Acknowledgements: what every command packet is answered with. The body is the same in all dialects; the
// Space Packet around it here is hilcam's own. Pure functions over bytes.

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
    std::uint64_t token = 0;  // of a ping; of a clock command, sender_ns
    TimeTai simulated_time;
    std::string reason;  // up to 96 bytes of it travel
    // With an accepted clock command. simulated_time and `departure` are one: both travel as the former.
    std::optional<ClockReading> clock{};
};

// Gives the number of bytes written. `count` is the primary header's 14-bit counter.
std::size_t encode_acknowledgement(const Acknowledgement& acknowledgement, std::uint16_t count,
                                   std::span<std::uint8_t> bytes);
// False when the bytes are no acknowledgement.
bool decode_acknowledgement(std::span<const std::uint8_t> packet, Acknowledgement& acknowledgement);

// From the protocol version on, without the check at the end.
void write_acknowledgement_body(const Acknowledgement& acknowledgement, ByteWriter& out);
bool read_acknowledgement_body(std::span<const std::uint8_t> body, Acknowledgement& acknowledgement);

// "accepted", "bad checksum", ...
std::string_view name_of(CommandStatus status);
// Returns the name of its status and, behind a colon, its reason as a terminal can show it: whoever answers
// writes that.
std::string text_of(const Acknowledgement& a);
// Why, in a line: what refusals give as their reason where the command itself is well formed.
std::string_view meaning_of(CommandStatus status);
// The same of a command, with what helps.
std::string_view meaning_of(CommandStatus status, const Command& command);

}  // namespace hilcam
