#include "io/commands/commands_unix.h"

#include <sys/socket.h>

#include <memory>

#include "io/commands/stream_server.h"
#include "io/system/unix_socket_file.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

bool admit(int socket, std::string& peer) {
    ucred who{};
    socklen_t size = sizeof who;
    if (getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &who, &size) != 0) return false;
    peer = "process " + std::to_string(who.pid) + " of user " + std::to_string(who.uid);
    return true;
}

}  // namespace

Fields fields(UnixCommandConfig& c) {
    Fields list = {
        required(path("path", c.path, "path of the socket, created at the start and removed at the end")),
        choice("type", c.type, {"stream", "seqpacket"}, "kind of socket"),
        integer("clients", c.clients, {1, 1000},
                "largest number of connections at a time; further ones are closed at once"),
    };
    add_fields(c.dialect, list);
    return list;
}

void validate(const UnixCommandConfig& c) {
    validate(c.dialect);
    unix_address(c.path.string());
}

std::unique_ptr<CommandReceiver> make_unix_receiver(const UnixCommandConfig& c, CommandHandler& handler) {
    const std::string path = c.path.string();
    const bool whole_packets = c.type == UnixCommandConfig::Type::kSeqpacket;
    auto file = std::make_shared<UnixSocketFile>();  // shared by two callbacks
    StreamServerSetup setup;
    setup.name = "unix " + path;
    setup.listen = [path, file, type = whole_packets ? SOCK_SEQPACKET : SOCK_STREAM] {
        return file->listen(path, type);
    };
    setup.closed = [file] { file->remove(); };
    setup.admit = admit;
    setup.max_clients = static_cast<std::size_t>(c.clients);
    setup.whole_packets = whole_packets;
    return std::make_unique<StreamServer>(std::move(setup), handler, c.dialect);
}

}  // namespace hilcam
