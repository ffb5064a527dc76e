#include "io/commands/commands_unix.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <cerrno>
#include <cstring>

#include "io/commands/stream_server.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// Device and inode, to test whether the file is still ours.
struct FileIdentity {
    dev_t device = 0;
    ino_t inode = 0;

    static FileIdentity of(const std::string& path) {
        struct stat s {};
        return lstat(path.c_str(), &s) == 0 ? FileIdentity{s.st_dev, s.st_ino} : FileIdentity{};
    }
    friend bool operator==(const FileIdentity&, const FileIdentity&) = default;
};

// True for a socket file without a listener.
bool is_stale(const std::string& path, int type) {
    struct stat s {};
    if (lstat(path.c_str(), &s) != 0 || !S_ISSOCK(s.st_mode)) return false;
    const Fd probe(socket(AF_UNIX, type | SOCK_CLOEXEC, 0));
    const sockaddr_un there = unix_address(path);
    return connect(probe.get(), reinterpret_cast<const sockaddr*>(&there), sizeof there) != 0 &&
           errno == ECONNREFUSED;
}

Fd listen_unix(const std::string& path, int type) {
    Fd fd(socket(AF_UNIX, type | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (!fd) throw DeviceError(std::string("no Unix socket: ") + std::strerror(errno));
    const sockaddr_un where = unix_address(path);
    const auto try_bind = [&] {
        return bind(fd.get(), reinterpret_cast<const sockaddr*>(&where), sizeof where) == 0;
    };
    bool bound = try_bind();
    if (!bound && errno == EADDRINUSE && is_stale(path, type)) {
        unlink(path.c_str());
        bound = try_bind();
    }
    if (!bound && errno == EADDRINUSE)
        throw DeviceError("Unix socket " + path +
                          " is taken by another program, or is some other file; stop it (ss -xlp shows it) "
                          "or choose another path");
    if (!bound) throw DeviceError("Unix socket " + path + " cannot be made: " + std::strerror(errno));
    chmod(path.c_str(), 0660);
    if (listen(fd.get(), 16) != 0)
        throw DeviceError("Unix socket " + path + " cannot be listened at: " + std::strerror(errno));
    return fd;
}

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
    auto ours = std::make_shared<FileIdentity>();  // shared by two callbacks
    StreamServerSetup setup;
    setup.name = "unix " + path;
    setup.listen = [path, ours, type = whole_packets ? SOCK_SEQPACKET : SOCK_STREAM] {
        Fd fd = listen_unix(path, type);
        *ours = FileIdentity::of(path);
        return fd;
    };
    setup.closed = [path, ours] {
        if (FileIdentity::of(path) == *ours) unlink(path.c_str());
    };
    setup.admit = admit;
    setup.max_clients = static_cast<std::size_t>(c.clients);
    setup.whole_packets = whole_packets;
    return std::make_unique<StreamServer>(std::move(setup), handler, c.dialect);
}

}  // namespace hilcam
