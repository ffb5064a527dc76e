#include "io/commands/command_link.h"

#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

#include "io/system/fd.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// A connected socket of any kind.
class SocketLink : public CommandLink {
  public:
    SocketLink(Fd socket, bool datagrams) : socket_(std::move(socket)), datagrams_(datagrams) {}

    bool send(std::span<const std::uint8_t> packet) override {
        while (!packet.empty()) {
            const ssize_t sent = ::send(socket_.get(), packet.data(), packet.size(), MSG_NOSIGNAL);
            if (sent < 0 && errno == EINTR) continue;
            // Over UDP, ECONNREFUSED is the answer to an earlier datagram: there is no listener, or none yet.
            if (sent < 0) return datagrams_ && errno == ECONNREFUSED;
            packet = packet.subspan(static_cast<std::size_t>(sent));
        }
        return true;
    }

    Received receive(std::span<std::uint8_t> room, int timeout_ms) override {
        pollfd watched{socket_.get(), POLLIN, 0};
        if (poll(&watched, 1, timeout_ms) <= 0) return {};
        const ssize_t got = recv(socket_.get(), room.data(), room.size(), MSG_DONTWAIT);
        if (got > 0) return {static_cast<std::size_t>(got), false};
        return {0, got == 0 ? !datagrams_ : errno != EAGAIN && errno != EINTR};
    }

  private:
    Fd socket_;
    bool datagrams_;
};

DeviceError nobody_at(const std::string& endpoint) {
    return DeviceError(endpoint + ": " + std::strerror(errno) + "; is 'hilcam run' up and listening there?");
}

std::unique_ptr<CommandLink> open_socket(const std::string& endpoint, const std::string& where, int type) {
    Fd fd(socket(AF_INET, type | SOCK_CLOEXEC, 0));
    const sockaddr_in to = parse_endpoint(where);
    if (connect(fd.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) throw nobody_at(endpoint);
    const int on = 1;
    if (type == SOCK_STREAM) setsockopt(fd.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    return std::make_unique<SocketLink>(std::move(fd), type == SOCK_DGRAM);
}

std::unique_ptr<CommandLink> open_unix(const std::string& endpoint, const std::string& path) {
    const sockaddr_un to = unix_address(path);
    for (const int type : {SOCK_STREAM, SOCK_SEQPACKET}) {
        Fd fd(socket(AF_UNIX, type | SOCK_CLOEXEC, 0));
        if (connect(fd.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0)
            return std::make_unique<SocketLink>(std::move(fd), false);
        if (errno != EPROTOTYPE) break;
    }
    throw nobody_at(endpoint);
}

}  // namespace

std::unique_ptr<CommandLink> open_command_link(const std::string& endpoint) {
    const std::size_t colon = endpoint.find(':');
    const std::string kind = endpoint.substr(0, colon);
    const std::string rest = colon == std::string::npos ? std::string{} : endpoint.substr(colon + 1);
    if (kind == "udp") return open_socket(endpoint, rest, SOCK_DGRAM);
    if (kind == "tcp") return open_socket(endpoint, rest, SOCK_STREAM);
    if (kind == "unix") return open_unix(endpoint, rest);
    if (kind == "usb") return open_usb_link(rest);
    return open_socket(endpoint, endpoint, SOCK_DGRAM);
}

}  // namespace hilcam
