#pragma once
// The sending side of the command protocol: sends commands, waits for acknowledgements, receives telemetry.

#include <cstdint>
#include <deque>
#include <memory>
#include <string>

#include "io/commands/command_dialect.h"
#include "io/commands/command_link.h"
#include "render/vocabulary/check.h"

namespace hilcam {

class CommandSender {
  public:
    // endpoint: see open_command_link(). Throws InputError and DeviceError.
    explicit CommandSender(const std::string& endpoint, const DialectConfig& dialect = {});

    // Sends once and waits. Throws DeviceError when no acknowledgement comes in time.
    Acknowledgement send(const Command& command, int timeout_ms = 1000);
    // Sets the sequence number of the next command, from which the following count up; 0 by default.
    void begin_at(std::uint32_t sequence) { sequence_ = sequence; }
    // Sets the camera for the following commands, from 1; 0: all. Not possible in the cFS dialect.
    void address(std::uint16_t camera) { camera_ = camera; }
    // Gets the next telemetry packet; false when none comes in time. Throws DeviceError when the link breaks.
    bool receive(Telemetry& telemetry, int timeout_ms);

  private:
    DeviceError silent(int timeout_ms) const;
    // Gets one packet of the stream; false at the deadline.
    bool next_packet(std::span<const std::uint8_t>& packet, std::int64_t deadline_ns);

    std::string endpoint_;
    DialectConfig dialect_;
    std::unique_ptr<CommandLink> link_;
    PacketStream stream_;
    std::deque<Telemetry> waiting_;  // came while an acknowledgement was awaited; the last 1000
    std::uint16_t camera_ = 0;
    std::uint32_t sequence_ = 0;
};

}  // namespace hilcam
