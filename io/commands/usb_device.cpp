#include "io/commands/usb_device.h"

#include <libusb.h>

#include <algorithm>
#include <array>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

std::string serial_of(libusb_device_handle* handle, const libusb_device_descriptor& d) {
    std::array<unsigned char, 256> text{};
    if (d.iSerialNumber == 0) return {};
    const int size = libusb_get_string_descriptor_ascii(handle, d.iSerialNumber, text.data(),
                                                        static_cast<int>(text.size()));
    return size > 0 ? std::string(reinterpret_cast<const char*>(text.data()), static_cast<std::size_t>(size))
                    : std::string{};
}

struct BulkPair {
    int interface = -1;
    std::uint8_t in = 0, out = 0;
};

BulkPair bulk_pair_of(const libusb_interface_descriptor& description) {
    BulkPair pair;
    if (description.bInterfaceClass != LIBUSB_CLASS_VENDOR_SPEC) return pair;
    for (int i = 0; i < description.bNumEndpoints; ++i) {
        const libusb_endpoint_descriptor& e = description.endpoint[i];
        if ((e.bmAttributes & LIBUSB_TRANSFER_TYPE_MASK) != LIBUSB_TRANSFER_TYPE_BULK) continue;
        std::uint8_t& address = e.bEndpointAddress & LIBUSB_ENDPOINT_IN ? pair.in : pair.out;
        if (address == 0) address = e.bEndpointAddress;
    }
    if (pair.in != 0 && pair.out != 0) pair.interface = description.bInterfaceNumber;
    return pair;
}

BulkPair find_bulk_pair(libusb_device* device) {
    libusb_config_descriptor* config = nullptr;
    if (libusb_get_active_config_descriptor(device, &config) != 0) return {};
    BulkPair pair;
    for (int i = 0; i < config->bNumInterfaces && pair.interface < 0; ++i)
        if (config->interface[i].num_altsetting > 0) pair = bulk_pair_of(config->interface[i].altsetting[0]);
    libusb_free_config_descriptor(config);
    return pair;
}

UsbDevice open_device(libusb_device* device, const libusb_device_descriptor& d, const UsbId& id,
                      std::string& why) {
    libusb_device_handle* raw = nullptr;
    if (const int error = libusb_open(device, &raw); error != 0) {
        why = std::string("cannot be opened: ") + libusb_strerror(static_cast<libusb_error>(error)) +
              (error == LIBUSB_ERROR_ACCESS ? "; a udev rule gives this user the right" : "");
        return {};
    }
    UsbDevice out{{raw, {}}};
    if (!id.serial.empty() && serial_of(raw, d) != id.serial) return {};
    const BulkPair pair = find_bulk_pair(device);
    if (pair.interface < 0) {
        why = "has no vendor-specific interface with a bulk endpoint each way";
        return {};
    }
    libusb_set_auto_detach_kernel_driver(raw, 1);
    if (const int error = libusb_claim_interface(raw, pair.interface); error != 0) {
        why = std::string("its interface cannot be claimed: ") +
              libusb_strerror(static_cast<libusb_error>(error)) + "; another program may have it";
        return {};
    }
    out.handle.get_deleter().interface = pair.interface;
    out.in = pair.in, out.out = pair.out;
    return out;
}

}  // namespace

void UsbContextDeleter::operator()(libusb_context* context) const { libusb_exit(context); }

UsbContext make_usb_context() {
    libusb_context* context = nullptr;
    if (const int error = libusb_init(&context); error != 0)
        throw DeviceError(std::string("libusb cannot start: ") +
                          libusb_strerror(static_cast<libusb_error>(error)));
    return UsbContext(context);
}

void UsbHandleDeleter::operator()(libusb_device_handle* handle) const {
    if (interface >= 0) libusb_release_interface(handle, interface);
    libusb_close(handle);
}

UsbDevice open_usb(libusb_context* context, const UsbId& id, std::string& why) {
    why.clear();
    libusb_device** list = nullptr;
    const ssize_t count = libusb_get_device_list(context, &list);
    UsbDevice out;
    for (ssize_t i = 0; i < count && !out; ++i) {
        libusb_device_descriptor d;
        if (libusb_get_device_descriptor(list[i], &d) != 0) continue;
        if (d.idVendor == id.vendor && d.idProduct == id.product) out = open_device(list[i], d, id, why);
    }
    if (count >= 0) libusb_free_device_list(list, 1);
    return out;
}

}  // namespace hilcam
