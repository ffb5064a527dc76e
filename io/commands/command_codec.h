#pragma once
// Commands as Space Packets in hilcam's own dialect, byte by byte as in docs/protocol.md. Pure functions over
// bytes.

#include <cstdint>
#include <span>
#include <string_view>

#include "io/commands/acknowledgement.h"
#include "io/commands/ccsds.h"
#include "io/contract/command.h"

namespace hilcam {

inline constexpr std::uint16_t kCommandApid = 0x100;
inline constexpr std::size_t kMaxCommandBytes = 256;

// The contents of a packet, or the reason why it is refused. Header fields are set as far as they could be
// read.
struct DecodedCommand {
    CommandStatus status = CommandStatus::kAccepted;
    std::string_view reason;  // reason of a refusal; static text
    Command command;
    SpacePacketHeader header;
    std::uint8_t function = 0;
    std::uint16_t camera = 0;  // 0: all
    std::uint32_t sequence = 0;
    bool is_intact = false;  // the sequence number arrived undamaged; may be true for a refused packet
};

// Decodes one packet of exactly the length in its header.
DecodedCommand decode_command(std::span<const std::uint8_t> packet);
// Returns the number of bytes written.
std::size_t encode_command(const Command& command, std::uint32_t sequence, std::span<std::uint8_t> bytes,
                           std::uint16_t camera = 0);

}  // namespace hilcam
