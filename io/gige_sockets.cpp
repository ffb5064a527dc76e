#include "io/gige_sockets.h"

#include <sys/socket.h>

#include <algorithm>

#include "io/gvcp.h"
#include "render/check.h"

namespace hilcam {
namespace {

// Nothing when another program holds the address for itself: clients that know the camera's address still
// find it.
Fd open_broadcast(std::uint32_t address) {
    try {
        return open_udp(address, gvcp::kPort, true);
    } catch (const DeviceError&) {
        return {};
    }
}

}  // namespace

GigeSockets::GigeSockets(const NetInterface& net)
    : control_(open_udp(net.address, gvcp::kPort)), message_(open_udp(net.address, 0)) {
    broadcast_[0] = open_broadcast(INADDR_BROADCAST);
    if (net.mask != 0xFFFFFFFF) broadcast_[1] = open_broadcast(net.address | ~net.mask);
    const int on = 1;  // an answer may be for everybody
    setsockopt(control_.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
    sockaddr_in own{};
    socklen_t size = sizeof own;
    getsockname(message_.get(), reinterpret_cast<sockaddr*>(&own), &size);
    message_port_ = ntohs(own.sin_port);
}

void GigeSockets::wait(const Fd& wakeup, std::int64_t timeout_ns) {
    // poll() skips what is negative.
    watched_ = {{{wakeup.get(), POLLIN, 0},
                 {control_.get(), POLLIN, 0},
                 {broadcast_[0].get(), POLLIN, 0},
                 {broadcast_[1].get(), POLLIN, 0}}};
    const std::int64_t ns = std::max<std::int64_t>(0, timeout_ns);
    const timespec timeout{static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
    ppoll(watched_.data(), watched_.size(), &timeout, nullptr);
    std::uint64_t count = 0;
    if (watched_[0].revents) {
        [[maybe_unused]] const auto got = ::read(wakeup.get(), &count, sizeof count);
    }
}

void GigeSockets::take(const Receive& receive) {
    for (std::size_t i = 1; i < watched_.size(); ++i) {
        if (!watched_[i].revents) continue;
        for (int n = 0; n < kAtOnce; ++n) {
            std::array<std::uint8_t, 2048> bytes;
            sockaddr_in sender{};
            socklen_t size = sizeof sender;
            const ssize_t got = recvfrom(watched_[i].fd, bytes.data(), bytes.size(), MSG_DONTWAIT,
                                         reinterpret_cast<sockaddr*>(&sender), &size);
            if (got < 0) break;
            receive({bytes.data(), static_cast<std::size_t>(got)},
                    {ntohl(sender.sin_addr.s_addr), ntohs(sender.sin_port)}, i > 1);
        }
    }
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
