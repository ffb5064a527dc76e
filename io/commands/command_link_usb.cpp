#include <libusb.h>

#include <algorithm>
#include <array>

#include "io/commands/command_link.h"
#include "io/commands/usb_device.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr unsigned kSendTimeout_ms = 1000;

class UsbLink : public CommandLink {
  public:
    UsbLink(UsbContext context, UsbDevice device)
        : context_(std::move(context)), device_(std::move(device)) {}

    bool send(std::span<const std::uint8_t> packet) override {
        while (!packet.empty()) {
            std::array<std::uint8_t, 16384> bytes;
            const std::size_t size = std::min(packet.size(), bytes.size());
            std::copy_n(packet.begin(), size, bytes.begin());
            int done = 0;
            const int error = libusb_bulk_transfer(device_.handle.get(), device_.out, bytes.data(),
                                                   static_cast<int>(size), &done, kSendTimeout_ms);
            packet = packet.subspan(static_cast<std::size_t>(done));
            if (error != 0) return false;
        }
        return true;
    }

    // A transfer that timed out may have brought a part, so `done` counts whatever the error. The buffer is a
    // multiple of every packet size, because a packet must fit.
    Received receive(std::span<std::uint8_t> room, int timeout_ms) override {
        int done = 0;
        const std::size_t size = room.size() / 1024 * 1024;
        const int error =
            libusb_bulk_transfer(device_.handle.get(), device_.in, room.data(), static_cast<int>(size), &done,
                                 static_cast<unsigned>(std::max(timeout_ms, 1)));
        return {static_cast<std::size_t>(done), done == 0 && error != 0 && error != LIBUSB_ERROR_TIMEOUT};
    }

  private:
    UsbContext context_;
    UsbDevice device_;
};

}  // namespace

std::unique_ptr<CommandLink> open_usb_link(const std::string& text) {
    const UsbId id = parse_usb_id(text);
    UsbContext context = make_usb_context();
    std::string why;
    UsbDevice device = open_usb(context.get(), id, why);
    if (!device)
        throw DeviceError("USB device " + to_string(id) + " " +
                          (why.empty() ? "is not there ('lsusb' lists what is)" : why));
    return std::make_unique<UsbLink>(std::move(context), std::move(device));
}

}  // namespace hilcam
