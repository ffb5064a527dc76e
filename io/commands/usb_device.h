#pragma once
// A USB device with a bulk pair, found and claimed through libusb.

#include <cstdint>
#include <memory>
#include <string>

struct libusb_context;
struct libusb_device;
struct libusb_device_handle;

namespace hilcam {

struct UsbId {
    std::uint16_t vendor = 0, product = 0;
    std::string serial;  // empty: any
};
// "1209:0001" or "1209:0001:SERIAL", hexadecimal as lsusb prints them. Throws InputError.
UsbId parse_usb_id(const std::string& text);
std::string to_string(const UsbId& id);

struct UsbContextDeleter {
    void operator()(libusb_context* context) const;
};
using UsbContext = std::unique_ptr<libusb_context, UsbContextDeleter>;
// Throws DeviceError.
UsbContext make_usb_context();

struct UsbHandleDeleter {
    int interface = -1;  // claimed
    void operator()(libusb_device_handle* handle) const;
};

// Opened, one interface claimed. Endpoint addresses are those of the active configuration: controllers
// renumber them.
struct UsbDevice {
    std::unique_ptr<libusb_device_handle, UsbHandleDeleter> handle;
    std::uint8_t in = 0, out = 0;

    explicit operator bool() const { return handle != nullptr; }
};

// The first vendor-specific interface with a bulk endpoint each way, of the first device with that id; none
// when it is absent or cannot be used: then `why` says why, unless it is absent.
UsbDevice open_usb(libusb_context* context, const UsbId& id, std::string& why);

}  // namespace hilcam
