#pragma once
// The sender's link to an emulator: it takes packets, and returns pieces of the stream of answers.

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace hilcam {

class CommandLink {
  public:
    virtual ~CommandLink() = default;
    // Sends one whole packet. False when it cannot be sent.
    virtual bool send(std::span<const std::uint8_t> packet) = 0;
    // The result of waiting for bytes: 0 bytes when none came in time, `broken` when none can come any more.
    struct Received {
        std::size_t bytes = 0;
        bool broken = false;
    };
    virtual Received receive(std::span<std::uint8_t> room, int timeout_ms) = 0;
};

// Opens "udp:ADDRESS:PORT" or "ADDRESS:PORT", "tcp:ADDRESS:PORT", "unix:PATH" (either type of socket),
// "usb:VENDOR:PRODUCT[:SERIAL]". Throws InputError and DeviceError.
std::unique_ptr<CommandLink> open_command_link(const std::string& endpoint);
// Opens the last of these; id: without "usb:".
std::unique_ptr<CommandLink> open_usb_link(const std::string& id);

}  // namespace hilcam
