#pragma once
// The contents of a command between its headers and its check: the payloads of docs/protocol.md, which all
// dialects share. Pure functions over bytes.

#include <cstdint>
#include <optional>
#include <string_view>

#include "io/contract/command.h"
#include "io/system/bytes.h"

namespace hilcam {

// Why bytes are no command, or kAccepted. `reason` is static text.
struct Refusal {
    CommandStatus status = CommandStatus::kAccepted;
    std::string_view reason{};
};

// 1 to 12, in the order of Command's alternatives.
std::uint8_t function_of(const Command& command);
// "pose", "settings", ...; empty for a function that does not exist.
std::string_view name_of_function(std::uint8_t function);
// Bytes of the payload; none for a function that does not exist.
std::optional<std::size_t> payload_bytes(std::uint8_t function);

// Exactly payload_bytes(function) are read.
Refusal read_payload(ByteReader& in, std::uint8_t function, Command& command);
void write_payload(const Command& command, ByteWriter& out);

}  // namespace hilcam
