#include "io/gige/gige_sockets.h"

#include <net/if.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstring>

#include "io/gige/device/gvcp.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// Returns an empty Fd when another program has bound the address exclusively; clients that know the camera's
// address still find it.
Fd open_broadcast(std::uint32_t address) {
    try {
        return open_udp(address, gvcp::kPort, true);
    } catch (const DeviceError&) {
        return {};
    }
}

void report_interfaces(const Fd& socket) {
    const int on = 1;
    if (socket) setsockopt(socket.get(), IPPROTO_IP, IP_PKTINFO, &on, sizeof on);
}

// Linux gives the loopback interface of every network namespace this number (LOOPBACK_IFINDEX, net/flow.h).
constexpr unsigned kLoopback = 1;

struct Datagram {
    std::array<std::uint8_t, 2048> bytes;
    std::size_t size = 0;
    sockaddr_in sender{};
    unsigned interface = 0;  // on which it arrived; 0: the kernel did not say
};

// Returns false when there is none.
bool receive_from(int socket, Datagram& d) {
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(in_pktinfo))> control;
    iovec where{d.bytes.data(), d.bytes.size()};
    msghdr message{};
    message.msg_name = &d.sender;
    message.msg_namelen = sizeof d.sender;
    message.msg_iov = &where;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t got = recvmsg(socket, &message, MSG_DONTWAIT);
    if (got < 0) return false;
    d.size = static_cast<std::size_t>(got);
    d.interface = 0;
    for (cmsghdr* c = CMSG_FIRSTHDR(&message); c; c = CMSG_NXTHDR(&message, c)) {
        if (c->cmsg_level != IPPROTO_IP || c->cmsg_type != IP_PKTINFO) continue;
        in_pktinfo info;
        std::memcpy(&info, CMSG_DATA(c), sizeof info);
        d.interface = static_cast<unsigned>(info.ipi_ifindex);
    }
    return true;
}

}  // namespace

GigeSockets::GigeSockets(const NetInterface& net)
    // A card's second address may have a name of its own, as eth0:1; only the card matters.
    : interface_(net.name.substr(0, net.name.find(':'))),
      interface_number_(if_nametoindex(interface_.c_str())),
      control_(open_udp(net.address, gvcp::kPort)),
      message_(open_udp(net.address, 0)) {
    broadcast_[0] = open_broadcast(INADDR_BROADCAST);
    if (net.mask != 0xFFFFFFFF) broadcast_[1] = open_broadcast(net.address | ~net.mask);
    for (const Fd* socket : {&control_, &message_, &broadcast_[0], &broadcast_[1]})
        report_interfaces(*socket);
    const int on = 1;  // an answer may be a broadcast
    setsockopt(control_.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
    sockaddr_in own{};
    socklen_t size = sizeof own;
    getsockname(message_.get(), reinterpret_cast<sockaddr*>(&own), &size);
    message_port_ = ntohs(own.sin_port);
}

void GigeSockets::wait(const Fd& wakeup, std::int64_t timeout_ns) {
    // poll() ignores negative descriptors.
    watched_ = {{{wakeup.get(), POLLIN, 0},
                 {control_.get(), POLLIN, 0},
                 {broadcast_[0].get(), POLLIN, 0},
                 {broadcast_[1].get(), POLLIN, 0},
                 {message_.get(), POLLIN, 0}}};
    const std::int64_t ns = std::max<std::int64_t>(0, timeout_ns);
    const timespec timeout{static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
    ppoll(watched_.data(), watched_.size(), &timeout, nullptr);
    std::uint64_t count = 0;
    if (watched_[0].revents) {
        [[maybe_unused]] const auto got = ::read(wakeup.get(), &count, sizeof count);
    }
}

std::uint64_t GigeSockets::take(const Receive& receive) {
    std::uint64_t strange = 0;
    Datagram d;
    for (std::size_t i = 1; i < watched_.size(); ++i) {
        if (!watched_[i].revents) continue;
        const bool broadcast = watched_[i].fd == broadcast_[0].get() || watched_[i].fd == broadcast_[1].get();
        const bool message = watched_[i].fd == message_.get();
        for (int n = 0; n < kAtOnce && receive_from(watched_[i].fd, d); ++n) {
            // Clients send acknowledgements of events to this socket, and commands to the other one.
            if (message && d.size > 0 && d.bytes[0] == gvcp::Header::kKey) continue;
            if (is_heard(d.interface, broadcast))
                receive({d.bytes.data(), d.size}, {ntohl(d.sender.sin_addr.s_addr), ntohs(d.sender.sin_port)},
                        broadcast);
            else
                ++strange;
        }
    }
    return strange;
}

bool GigeSockets::is_heard(unsigned interface, bool broadcast) {
    if (interface == 0) return false;
    if (interface == interface_number_) return true;
    // A packet from a program on this machine to one of its addresses arrives on the loopback interface.
    if (interface == kLoopback && !broadcast) return true;
    char name[IF_NAMESIZE] = {};
    if (!if_indextoname(interface, name) || interface_ != name) return false;
    interface_number_ = interface;
    return true;
}

void GigeSockets::send(const Fd& socket, std::span<const std::uint8_t> bytes, Endpoint to) noexcept {
    const sockaddr_in address = socket_address(to.ip, to.port);
    sendto(socket.get(), bytes.data(), bytes.size(), MSG_DONTWAIT,
           reinterpret_cast<const sockaddr*>(&address), sizeof address);
}
void GigeSockets::send_answer(std::span<const std::uint8_t> bytes, Endpoint to) noexcept {
    send(control_, bytes, to);
}
void GigeSockets::send_message(std::span<const std::uint8_t> bytes, Endpoint to) noexcept {
    send(message_, bytes, to);
}

}  // namespace hilcam
