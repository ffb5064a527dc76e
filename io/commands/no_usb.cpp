// Stands in for libusb where hilcam is built without it (HILCAM_USB=OFF).

#include "io/commands/command_link.h"
#include "io/commands/commands_usb.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

InputError built_without_usb(const std::string& asked) {
    return InputError(asked +
                      ": this hilcam was built without USB; build it with -DHILCAM_USB=ON and libusb-1.0");
}

}  // namespace

std::unique_ptr<CommandReceiver> make_usb_receiver(const UsbCommandConfig& config, CommandHandler&,
                                                   FaultBoard&) {
    throw built_without_usb("commands.usb.device " + config.device);
}

std::unique_ptr<CommandLink> open_usb_link(const std::string& id) { throw built_without_usb("usb:" + id); }

}  // namespace hilcam
