#pragma once
// The contents of a command between its headers and its check: the payloads of docs/protocol.md, which all
// dialects share. Pure functions over bytes.

#include <cstdint>
#include <optional>
#include <string_view>

#include "io/contract/command.h"
#include "io/system/bytes.h"

namespace hilcam {

// The reason why bytes are no command, or kAccepted. reason: static text.
struct Refusal {
    CommandStatus status = CommandStatus::kAccepted;
    std::string_view reason{};
};

// Returns the function code, 1 to 12, in the order of Command's alternatives.
std::uint8_t function_of(const Command& command);
// Returns "pose", "settings", ...; empty for an unknown function.
std::string_view name_of_function(std::uint8_t function);
// Returns the payload's length; nothing for an unknown function.
std::optional<std::size_t> payload_bytes(std::uint8_t function);

// Reads exactly payload_bytes(function) bytes.
Refusal read_payload(ByteReader& in, std::uint8_t function, Command& command);
void write_payload(const Command& command, ByteWriter& out);

}  // namespace hilcam
