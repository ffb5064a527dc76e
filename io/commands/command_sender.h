#pragma once
// The sending side of the command protocol: sends, waits for acknowledgements, listens to telemetry.

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
    // Takes an endpoint as open_command_link() does. Throws InputError, DeviceError.
    explicit CommandSender(const std::string& endpoint, const DialectConfig& dialect = {});

    // Sends once and waits. Throws DeviceError when no acknowledgement comes in time.
    Acknowledgement send(const Command& command, int timeout_ms = 1000);
    // The sequence number of the next command; each further one has one more. Not told: 0.
    void begin_at(std::uint32_t sequence) { sequence_ = sequence; }
    // Sets the camera that the following commands are for, from 1; 0: every one. Not of the cFS dialect.
    void address(std::uint16_t camera) { camera_ = camera; }
    // The next telemetry packet; false when none comes in time. Throws DeviceError when the link breaks.
    bool receive(Telemetry& telemetry, int timeout_ms);

  private:
    DeviceError silent(int timeout_ms) const;
    // One packet of the stream; false at the deadline.
    bool next_packet(std::span<const std::uint8_t>& packet, std::int64_t deadline_ns);

    std::string endpoint_;
    DialectConfig dialect_;
    std::unique_ptr<CommandLink> link_;
    PacketStream stream_;
    std::deque<Telemetry> waiting_;  // came while an acknowledgement was waited for; the last 1000
    std::uint16_t camera_ = 0;
    std::uint32_t sequence_ = 0;
};

}  // namespace hilcam
