#include "emulator/command_receivers.h"

namespace hilcam {

std::vector<std::unique_ptr<CommandReceiver>> make_receivers(const CommandsConfig& c, CommandHandler& handler,
                                                             FaultBoard& faults) {
    std::vector<std::unique_ptr<CommandReceiver>> out;
    if (c.has_udp) out.push_back(std::make_unique<UdpCommandReceiver>(c.udp, handler));
    if (c.has_tcp) out.push_back(make_tcp_receiver(c.tcp, handler));
    if (c.has_unix) out.push_back(make_unix_receiver(c.unix_socket, handler));
    if (c.has_usb) out.push_back(make_usb_receiver(c.usb, handler, faults));
    if (c.has_functionfs) out.push_back(make_functionfs_receiver(c.functionfs, handler, faults));
    return out;
}

CommandReport report_of(const std::vector<std::unique_ptr<CommandReceiver>>& receivers) {
    CommandReport sum;
    for (const auto& receiver : receivers) sum += receiver->report();
    return sum;
}

}  // namespace hilcam
