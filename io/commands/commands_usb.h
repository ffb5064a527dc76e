#pragma once
// Commands from a USB device that the bench plugs into this machine: packets on its bulk IN endpoint, answers
// and telemetry on its bulk OUT endpoint, through libusb.
//
// The device may come and go at any time. Transfers may be split anywhere: packets are found as in TCP's
// stream. Answers that the device does not take are queued up to 256 KiB, then dropped.

#include <memory>
#include <string>

#include "io/commands/command_dialect.h"
#include "io/contract/command_receiver.h"
#include "io/contract/fault.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct UsbCommandConfig {
    std::string device;  // "1209:0001" or "1209:0001:SERIAL"
    DialectConfig dialect{};
};
Fields fields(UsbCommandConfig& config);
void validate(const UsbCommandConfig& config);

// Faults: usb_detach (the device is released), usb_short_transfer, usb_stall, usb_bad_crc. start() throws
// DeviceError when libusb fails; it waits for a device that is absent.
std::unique_ptr<CommandReceiver> make_usb_receiver(const UsbCommandConfig& config, CommandHandler& handler,
                                                   FaultBoard& faults);

}  // namespace hilcam
