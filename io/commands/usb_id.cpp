// Identifies a USB device, with the keys for it; the same with libusb and without.

#include <charconv>
#include <cstdio>

#include "io/commands/commands_usb.h"
#include "io/commands/usb_device.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {

UsbId parse_usb_id(const std::string& text) {
    const auto fail = [&]() -> InputError {
        return InputError(in_quotes(text) +
                          ": accepted: VENDOR:PRODUCT or VENDOR:PRODUCT:SERIAL, hexadecimal as "
                          "lsusb prints them, as 1209:0001");
    };
    UsbId id;
    const char *at = text.data(), *const last = text.data() + text.size();
    for (std::uint16_t* number : {&id.vendor, &id.product}) {
        if (number == &id.product) {
            if (at == last || *at != ':') throw fail();
            ++at;
        }
        const auto [end, error] = std::from_chars(at, last, *number, 16);
        if (error != std::errc{} || end == at) throw fail();
        at = end;
    }
    if (at == last) return id;
    if (*at != ':' || at + 1 == last) throw fail();
    id.serial.assign(at + 1, last);
    return id;
}

std::string to_string(const UsbId& id) {
    char text[16];
    std::snprintf(text, sizeof text, "%04x:%04x", unsigned{id.vendor}, unsigned{id.product});
    return text + (id.serial.empty() ? "" : ":" + id.serial);
}

Fields fields(UsbCommandConfig& c) {
    Fields list = {required(text(
        "device", c.device, "VENDOR:PRODUCT or VENDOR:PRODUCT:SERIAL, hexadecimal as lsusb prints them"))};
    add_fields(c.dialect, list);
    return list;
}

void validate(const UsbCommandConfig& c) {
    validate(c.dialect);
    parse_usb_id(c.device);
}

}  // namespace hilcam
