#pragma once
// Commands over USB with this machine as the device (it has a USB device controller) and the bench, an
// on-board computer or a dynamics simulator, as the host. Packets come in on the bulk OUT endpoint of a
// FunctionFS function; answers and telemetry go out on its bulk IN endpoint.
//
// The user creates the gadget (ids, serial number, other functions) through configfs; docs/protocol.md has
// the commands. With `gadget`, hilcam binds it to a controller once the descriptors are written, and unbinds
// it at the end.

#include <filesystem>
#include <memory>
#include <string>

#include "io/commands/command_dialect.h"
#include "io/contract/command_receiver.h"
#include "io/contract/fault.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct FunctionFsConfig {
    std::filesystem::path mount = "/dev/ffs-hilcam";
    std::filesystem::path gadget;  // empty: the user binds it
    std::string controller;        // empty: the first one
    DialectConfig dialect{};
};
Fields fields(FunctionFsConfig& config);
void validate(const FunctionFsConfig& config);

// start() throws DeviceError. Faults: usb_short_transfer, usb_stall, usb_bad_crc and, with `gadget`,
// usb_detach (the gadget is unbound).
std::unique_ptr<CommandReceiver> make_functionfs_receiver(const FunctionFsConfig& config,
                                                          CommandHandler& handler, FaultBoard& faults);

}  // namespace hilcam
