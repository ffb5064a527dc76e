#pragma once
// The sending side's way to an emulator: packets out, pieces of the stream of answers in.

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace hilcam {

class CommandLink {
  public:
    virtual ~CommandLink() = default;
    // One whole packet. False when it cannot be sent.
    virtual bool send(std::span<const std::uint8_t> packet) = 0;
    // Waits for bytes; 0 when none came in time. `broken` when none can come any more.
    struct Received {
        std::size_t bytes = 0;
        bool broken = false;
    };
    virtual Received receive(std::span<std::uint8_t> room, int timeout_ms) = 0;
};

// "udp:ADDRESS:PORT" or "ADDRESS:PORT", "tcp:ADDRESS:PORT", "unix:PATH" (either type of socket),
// "usb:VENDOR:PRODUCT[:SERIAL]". Throws InputError, DeviceError.
std::unique_ptr<CommandLink> open_command_link(const std::string& endpoint);
// The last of these; `id` without "usb:".
std::unique_ptr<CommandLink> open_usb_link(const std::string& id);

}  // namespace hilcam
