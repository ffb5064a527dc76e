#include "io/ip42/ip42_peer.h"

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "io/system/tcp_peer.h"

namespace hilcam {
namespace {

constexpr int kCall_ms = 2000;  // longest attempt to connect
constexpr int kPause_ms = 200;  // from one attempt to the next
constexpr int kListen_ms = 1000;

// Waits for an event; true when it came. A wakeup ends the wait.
bool wait_for(const Fd& wakeup, int fd, short events, int timeout_ms) {
    std::array<pollfd, 2> watched{{{wakeup.get(), POLLIN, 0}, {fd, events, 0}}};
    return poll(watched.data(), watched.size(), timeout_ms) > 0 && watched[0].revents == 0 &&
           watched[1].revents != 0;
}

// A client's attempt at a port from the range of its own ports, at which nobody listens, may connect the
// socket to itself (TCP's simultaneous open).
bool is_itself(const Fd& socket) {
    sockaddr_in own{}, other{};
    socklen_t own_size = sizeof own, other_size = sizeof other;
    return getsockname(socket.get(), reinterpret_cast<sockaddr*>(&own), &own_size) == 0 &&
           getpeername(socket.get(), reinterpret_cast<sockaddr*>(&other), &other_size) == 0 &&
           own.sin_port == other.sin_port && own.sin_addr.s_addr == other.sin_addr.s_addr;
}

}  // namespace

Ip42Peer::Ip42Peer(Setup setup)
    : setup_(std::move(setup)),
      address_(parse_ipv4(setup_.address, "commands.ip42.address")),
      allow_(setup_.serves ? setup_.allow : std::vector<std::string>{"any"}, setup_.address,
             "commands.ip42") {}

void Ip42Peer::open() {
    if (setup_.serves) listener_ = listen_tcp(address_, setup_.port);
}

std::string Ip42Peer::trouble() const {
    const std::lock_guard lock(mutex_);
    return trouble_;
}

Fd Ip42Peer::meet(const Fd& wakeup) {
    Fd socket = setup_.serves ? receive(wakeup) : call(wakeup);
    if (!socket) return {};
    if (!admit_tcp(allow_, socket.get(), name_)) {
        strangers_.fetch_add(1);
        return {};
    }
    const std::lock_guard lock(mutex_);
    trouble_.clear();
    met_ = true;
    return socket;
}

Fd Ip42Peer::fail(int error) {
    const std::lock_guard lock(mutex_);
    trouble_ = "42 does not answer at " + setup_.address + ":" + std::to_string(setup_.port) + ": " +
               std::strerror(error) + " (SERVER in its Inp_IPC.txt?)";
    return {};
}

Fd Ip42Peer::call(const Fd& wakeup) {
    Fd socket(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    const sockaddr_in where = socket_address(address_, setup_.port);
    int error = 0;
    if (connect(socket.get(), reinterpret_cast<const sockaddr*>(&where), sizeof where) != 0) error = errno;
    if (error == EINPROGRESS) {
        socklen_t size = sizeof error;
        if (!wait_for(wakeup, socket.get(), POLLOUT, kCall_ms))
            error = ETIMEDOUT;
        else if (getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &error, &size) != 0)
            error = errno;
    }
    if (error == 0 && is_itself(socket)) error = ECONNREFUSED;
    if (error == 0) return socket;
    socket.reset();
    wait_for(wakeup, -1, 0, kPause_ms);
    return fail(error);
}

Fd Ip42Peer::receive(const Fd& wakeup) {
    if (!wait_for(wakeup, listener_.get(), POLLIN, kListen_ms)) return {};
    Fd socket(accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    // Without a free descriptor it would fail again at once.
    if (!socket) wait_for(wakeup, -1, 0, kPause_ms);
    return socket;
}

}  // namespace hilcam
