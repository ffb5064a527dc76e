#include "io/gige/stream/receiver_room.h"

#include <linux/inet_diag.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <linux/sock_diag.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <time.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

namespace hilcam {
namespace {

constexpr std::int64_t kLookAgain_ns = 100'000;

struct Request {
    nlmsghdr header;
    inet_diag_req_v2 socket;
};

Request request_for(const sockaddr_in& from, const sockaddr_in& to) {
    Request request{};
    request.header.nlmsg_len = sizeof request;
    request.header.nlmsg_type = SOCK_DIAG_BY_FAMILY;
    request.header.nlmsg_flags = NLM_F_REQUEST;
    request.socket.sdiag_family = AF_INET;
    request.socket.sdiag_protocol = IPPROTO_UDP;
    request.socket.idiag_ext = 1u << (INET_DIAG_SKMEMINFO - 1);
    request.socket.idiag_states = ~0u;
    // The kernel looks the socket up as for a datagram, by source and destination.
    request.socket.id.idiag_sport = from.sin_port;
    request.socket.id.idiag_dport = to.sin_port;
    request.socket.id.idiag_src[0] = from.sin_addr.s_addr;
    request.socket.id.idiag_dst[0] = to.sin_addr.s_addr;
    request.socket.id.idiag_cookie[0] = request.socket.id.idiag_cookie[1] = INET_DIAG_NOCOOKIE;
    return request;
}

// Returns the free bytes by the memory figures in an answer; nothing for an error or another message.
std::optional<std::size_t> free_bytes_in(const std::uint8_t* bytes, std::size_t size) {
    nlmsghdr header;
    constexpr std::size_t kFixed = NLMSG_LENGTH(sizeof(inet_diag_msg));
    if (size < kFixed) return {};
    std::memcpy(&header, bytes, sizeof header);
    if (header.nlmsg_type != SOCK_DIAG_BY_FAMILY || header.nlmsg_len > size) return {};
    for (std::size_t at = kFixed; at + sizeof(rtattr) <= header.nlmsg_len;) {
        rtattr attribute;
        std::memcpy(&attribute, bytes + at, sizeof attribute);
        if (attribute.rta_len < sizeof attribute || at + attribute.rta_len > header.nlmsg_len) return {};
        std::array<std::uint32_t, 2> memory;  // SK_MEMINFO_RMEM_ALLOC, SK_MEMINFO_RCVBUF
        if (attribute.rta_type == INET_DIAG_SKMEMINFO && attribute.rta_len >= RTA_LENGTH(sizeof memory)) {
            std::memcpy(&memory, bytes + at + RTA_LENGTH(0), sizeof memory);
            return memory[0] < memory[1] ? memory[1] - memory[0] : 0;
        }
        at += RTA_ALIGN(attribute.rta_len);
    }
    return {};
}

}  // namespace

ReceiverRoom::ReceiverRoom() : netlink_(socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_SOCK_DIAG)) {
    if (!netlink_) return;
    const timeval patience{0, 1000};  // the kernel answers during the request; this is for one that does not
    setsockopt(netlink_.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
}

std::optional<std::size_t> ReceiverRoom::free_bytes(const sockaddr_in& from,
                                                    const sockaddr_in& to) const noexcept {
    if (!netlink_) return {};
    const Request request = request_for(from, to);
    if (send(netlink_.get(), &request, sizeof request, 0) != sizeof request) return {};
    alignas(nlmsghdr) std::array<std::uint8_t, 1024> answer;
    const ssize_t size = recv(netlink_.get(), answer.data(), answer.size(), 0);
    return size > 0 ? free_bytes_in(answer.data(), static_cast<std::size_t>(size)) : std::nullopt;
}

void ReceiverRoom::wait(const sockaddr_in& from, const sockaddr_in& to, std::size_t bytes,
                        const std::atomic<bool>& stop) noexcept {
    const bool unread = unread_.sin_port == to.sin_port && unread_.sin_addr.s_addr == to.sin_addr.s_addr;
    auto free = free_bytes(from, to);
    if (unread && free && *free < bytes) return;
    unread_ = {};
    std::size_t before = 0;
    std::int64_t waited_ns = 0;
    while (free && *free < bytes && !stop.load(std::memory_order_relaxed)) {
        if (*free > before) waited_ns = 0;
        before = *free;
        if (waited_ns >= kPatience_ns) {
            unread_ = to;
            return;
        }
        const timespec pause{0, kLookAgain_ns};
        clock_nanosleep(CLOCK_MONOTONIC, 0, &pause, nullptr);
        waited_ns += kLookAgain_ns;
        free = free_bytes(from, to);
    }
}

std::size_t ReceiverRoom::bytes_of(std::size_t datagram_bytes) {
    // SKB_TRUESIZE of Linux's include/linux/skbuff.h, 6.1 to 6.18 on x86-64; checked by a unit test.
    constexpr std::size_t kDescription = 256;  // struct sk_buff
    constexpr std::size_t kAround = 336;       // struct skb_shared_info and room for the link's header
    return std::bit_ceil(datagram_bytes + kAround) + kDescription;
}

}  // namespace hilcam
