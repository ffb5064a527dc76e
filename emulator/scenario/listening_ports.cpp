#include "emulator/scenario/listening_ports.h"

#include <map>

#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// Keys by the ports they listen on. 0.0.0.0 and interface names are compared as text, because only the
// machine of the run knows what they overlap with.
class Listeners {
  public:
    void add(const char* protocol, const std::string& key, const std::string& address, std::int64_t port) {
        if (port == 0) return;
        const std::string place = address + ":" + std::to_string(port);
        const auto [other, is_new] = taken_.emplace(protocol + place, key);
        if (!is_new)
            throw KeyError(key, std::string("found ") + protocol + " " + in_quotes(place) + ", where " +
                                    other->second +
                                    " listens, too; accepted: another address or port for each");
    }

  private:
    std::map<std::string, std::string> taken_;
};

void add_outputs(const std::string& prefix, const OutputsConfig& o, Listeners& listeners) {
    for (const ListeningPort& own : listening(o))
        listeners.add(own.tcp ? "TCP" : "UDP", prefix + own.key, own.address, own.port);
}

}  // namespace

void check_listening_ports(const ScenarioConfig& s) {
    Listeners listeners;
    if (s.commands.has_udp)
        listeners.add("UDP", "commands.udp.port", s.commands.udp.address, s.commands.udp.port);
    if (s.commands.has_tcp)
        listeners.add("TCP", "commands.tcp.port", s.commands.tcp.address, s.commands.tcp.port);
    if (s.commands.has_ip42 && s.commands.ip42.role == Ip42Role::kServer)
        listeners.add("TCP", "commands.ip42.port", s.commands.ip42.address, s.commands.ip42.port);
    if (s.telemetry)
        listeners.add("TCP", "telemetry.port", s.telemetry->port.address, s.telemetry->port.port);
    if (s.lines.udp) listeners.add("UDP", "lines.udp.port", s.lines.udp->address, s.lines.udp->port);
    add_outputs("", s.outputs, listeners);
    for (std::size_t i = 0; i < s.more_cameras.size(); ++i)
        add_outputs("more_cameras." + std::to_string(i) + ".", s.more_cameras[i].outputs, listeners);
}

}  // namespace hilcam
