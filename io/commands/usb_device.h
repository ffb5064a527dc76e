#pragma once
// A USB device with a pair of bulk endpoints, found and claimed through libusb.

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
// Parses "1209:0001" or "1209:0001:SERIAL", hexadecimal as lsusb prints them. Throws InputError.
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

// An open device with one claimed interface. Endpoint addresses are those of the active configuration,
// because controllers renumber them.
struct UsbDevice {
    std::unique_ptr<libusb_device_handle, UsbHandleDeleter> handle;
    std::uint8_t in = 0, out = 0;

    explicit operator bool() const { return handle != nullptr; }
};

// Opens the first usable device with that id, at its first vendor-specific interface with bulk endpoints in
// both directions. Returns an empty device when there is none (`why` stays empty) or it cannot be used (`why`
// has the reason).
UsbDevice open_usb(libusb_context* context, const UsbId& id, std::string& why);

}  // namespace hilcam
