#include "io/commands_tcp.h"

#include <netinet/tcp.h>
#include <sys/socket.h>

#include <memory>

#include "io/allow_list.h"
#include "io/stream_server.h"

namespace hilcam {
namespace {

// Nobody asks it anything: the clients of a read-only port are not listened to.
class NobodysHandler : public CommandHandler {
  public:
    CommandStatus handle(const Command&, const CommandSource&) override { return CommandStatus::kNotNow; }
    TimeTai now() const override { return {}; }
};

// Small packets leave at once; a peer that vanished without a word is noticed within half a minute.
void prepare(int socket) {
    const auto set = [&](int level, int name, int value) {
        setsockopt(socket, level, name, &value, sizeof value);
    };
    set(IPPROTO_TCP, TCP_NODELAY, 1);
    set(SOL_SOCKET, SO_KEEPALIVE, 1);
    set(IPPROTO_TCP, TCP_KEEPIDLE, 10);
    set(IPPROTO_TCP, TCP_KEEPINTVL, 5);
    set(IPPROTO_TCP, TCP_KEEPCNT, 4);
}

bool admit(const AllowList& allow, int socket, std::string& peer) {
    sockaddr_in from{};
    socklen_t size = sizeof from;
    if (getpeername(socket, reinterpret_cast<sockaddr*>(&from), &size) != 0) return false;
    peer = format_ipv4(ntohl(from.sin_addr.s_addr)) + ":" + std::to_string(ntohs(from.sin_port));
    prepare(socket);
    return allow.allows(ntohl(from.sin_addr.s_addr));
}

StreamServerSetup setup_of(const TcpCommandConfig& c, const std::string& kind, const std::string& key) {
    StreamServerSetup setup;
    setup.name = kind + " " + c.address + ":" + std::to_string(c.port);
    setup.listen = [address = parse_ipv4(c.address, key + ".address"),
                    port = static_cast<std::uint16_t>(c.port)] { return listen_tcp(address, port); };
    setup.admit = [allow = AllowList(c.allow, c.address, key)](int socket, std::string& peer) {
        return admit(allow, socket, peer);
    };
    setup.most_clients = static_cast<std::size_t>(c.clients);
    return setup;
}

}  // namespace

Fields fields(TcpCommandConfig& c) {
    Fields list = {
        text("address", c.address, "IPv4 address of this machine to listen on"),
        integer("port", c.port, {1, 65535}, "TCP port to listen on"),
        allow_field(c.allow),
        integer("clients", c.clients, {1, 1000}, "connections at a time; more are closed at once"),
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
