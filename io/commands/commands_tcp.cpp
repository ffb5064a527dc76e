#include "io/commands/commands_tcp.h"

#include <memory>

#include "io/commands/stream_server.h"
#include "io/system/allow_list.h"
#include "io/system/tcp_peer.h"

namespace hilcam {
namespace {

// A handler that is never called, because clients of a read-only port send no commands.
class NobodysHandler : public CommandHandler {
  public:
    CommandStatus handle(const Command&, const CommandSource&) override { return CommandStatus::kNotNow; }
    TimeTai now() const override { return {}; }
};

StreamServerSetup setup_of(const TcpCommandConfig& c, const std::string& kind, const std::string& key) {
    StreamServerSetup setup;
    setup.name = kind + " " + c.address + ":" + std::to_string(c.port);
    setup.listen = [address = parse_ipv4(c.address, key + ".address"),
                    port = static_cast<std::uint16_t>(c.port)] { return listen_tcp(address, port); };
    setup.admit = [allow = AllowList(c.allow, c.address, key)](int socket, std::string& peer) {
        return admit_tcp(allow, socket, peer);
    };
    setup.max_clients = static_cast<std::size_t>(c.clients);
    return setup;
}

}  // namespace

Fields fields(TcpCommandConfig& c) {
    Fields list = {
        text("address", c.address, "IPv4 address of this machine to listen on"),
        integer("port", c.port, {1, 65535}, "TCP port to listen on"),
        allow_field(c.allow),
        integer("clients", c.clients, {1, 1000},
                "largest number of connections at a time; further ones are closed at once"),
    };
    add_fields(c.dialect, list);
    return list;
}

void validate(const TcpCommandConfig& c) {
    validate(c.dialect);
    AllowList(c.allow, c.address, "commands.tcp");
}

std::unique_ptr<CommandReceiver> make_tcp_receiver(const TcpCommandConfig& c, CommandHandler& handler) {
    return std::make_unique<StreamServer>(setup_of(c, "tcp", "commands.tcp"), handler, c.dialect);
}

std::unique_ptr<CommandReceiver> make_telemetry_port(const TcpCommandConfig& c, const std::string& key) {
    static NobodysHandler nobody;
    StreamServerSetup setup = setup_of(c, "telemetry", key);
    setup.read_only = true;
    return std::make_unique<StreamServer>(std::move(setup), nobody, c.dialect);
}

}  // namespace hilcam
