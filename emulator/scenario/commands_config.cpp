#include "emulator/scenario/commands_config.h"

namespace hilcam {

Fields fields(CommandsConfig& c) {
    return {
        optional(section("udp", c.udp, "commands by UDP"), c.has_udp),
        optional(section("tcp", c.tcp, "commands by TCP, from several clients"), c.has_tcp),
        optional(section("unix", c.unix_socket, "commands by a Unix socket"), c.has_unix),
        optional(section("usb", c.usb, "commands from a USB device with a pair of bulk endpoints"),
                 c.has_usb),
        optional(section("functionfs", c.functionfs, "commands received as a USB device (FunctionFS)"),
                 c.has_functionfs),
        optional(section("vizard", c.vizard,
                         "commands from Basilisk, in place of Vizard (docs/vizard.md); needs mode: lockstep"),
                 c.has_vizard),
        optional(section("ip42", c.ip42, "states of the simulator 42, over TCP (docs/42.md)"), c.has_ip42),
        section("poses", c.poses, "treatment of missing poses and of poses whose time goes backwards"),
    };
}

}  // namespace hilcam
