#pragma once
// The section `commands`: the sources of commands, and the rules for their poses.

#include "emulator/world/pose_watch.h"
#include "io/commands/commands_functionfs.h"
#include "io/commands/commands_tcp.h"
#include "io/commands/commands_udp.h"
#include "io/commands/commands_unix.h"
#include "io/commands/commands_usb.h"
#include "io/ip42/commands_ip42.h"
#include "io/vizard/commands_vizard.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct CommandsConfig {
    bool has_udp = false, has_tcp = false, has_unix = false, has_usb = false, has_functionfs = false,
         has_vizard = false, has_ip42 = false;
    UdpCommandConfig udp;
    TcpCommandConfig tcp;
    UnixCommandConfig unix_socket;
    UsbCommandConfig usb;
    FunctionFsConfig functionfs;
    VizardConfig vizard;
    Ip42Config ip42;
    PoseRules poses;
};
Fields fields(CommandsConfig& commands);

}  // namespace hilcam
