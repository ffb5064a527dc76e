#include "io/ptp/ptp_sockets.h"

#include <linux/errqueue.h>
#include <linux/if_packet.h>
#include <linux/net_tstamp.h>
#include <net/ethernet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <string>

#include "io/system/clock_difference.h"
#include "io/system/monotonic.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::uint32_t kGroup = 0xE0000181;  // 224.0.1.129
constexpr std::uint16_t kEventPort = 319, kGeneralPort = 320, kEtherType = 0x88F7;
constexpr std::array<unsigned char, 6> kGroupMac = {0x01, 0x1B, 0x19, 0, 0, 0};
// A stamp that is older than this or more than this ahead was taken before CLOCK_REALTIME was set.
constexpr std::int64_t kOldestStamp_ns = 2'000'000'000, kMostAhead_ns = 1'000'000;

[[noreturn]] void refuse_socket(const std::string& what, const std::string& advice) {
    const int error = errno;
    const bool forbidden = error == EACCES || error == EPERM;
    throw DeviceError(what + ": " + std::strerror(error) + (forbidden ? "; " + advice : ""));
}

template <class T>
void set_option(const Fd& socket, int level, int name, const T& value, const std::string& what) {
    if (setsockopt(socket.get(), level, name, &value, sizeof value) != 0) refuse_socket(what, "");
}

void ask_for_stamps(const Fd& socket, const std::string& what) {
    const int flags = SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_TX_SOFTWARE |
                      SOF_TIMESTAMPING_SOFTWARE | SOF_TIMESTAMPING_OPT_ID | SOF_TIMESTAMPING_OPT_TSONLY;
    set_option(socket, SOL_SOCKET, SO_TIMESTAMPING, flags, what + ": time stamps");
}

Fd open_group(const NetInterface& net, int interface_number, std::uint16_t port) {
    const std::string what = "PTP on " + net.name + ": UDP port " + std::to_string(port);
    Fd socket(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!socket) refuse_socket(what, "");
    set_option(socket, SOL_SOCKET, SO_REUSEADDR, 1, what);
    // Bound to the group, the socket gets nothing else.
    const sockaddr_in own = socket_address(kGroup, port);
    if (bind(socket.get(), reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0)
        refuse_socket(
            what,
            "ports below 1024 need the right CAP_NET_BIND_SERVICE (sudo setcap cap_net_bind_service+ep "
            "HILCAM) or sysctl net.ipv4.ip_unprivileged_port_start=319");
    ip_mreqn membership{};
    membership.imr_multiaddr.s_addr = htonl(kGroup);
    membership.imr_address.s_addr = htonl(net.address);
    membership.imr_ifindex = interface_number;
    set_option(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, membership, what + ": multicast");
    set_option(socket, IPPROTO_IP, IP_MULTICAST_IF, membership, what + ": multicast");
    set_option(socket, IPPROTO_IP, IP_MULTICAST_ALL, 0, what);
    set_option(socket, IPPROTO_IP, IP_PKTINFO, 1, what);
    ask_for_stamps(socket, what);
    return socket;
}

std::int64_t ns_of(const timespec& t) { return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec; }

// Returns nothing for a stamp that cannot be: CLOCK_REALTIME was set meanwhile.
std::optional<std::int64_t> monotonic_of_stamp(const timespec& stamp) {
    if (stamp.tv_sec == 0 && stamp.tv_nsec == 0) return {};
    const std::int64_t ns = ns_of(stamp) - ahead_of_monotonic_ns(CLOCK_REALTIME);
    const std::int64_t age_ns = monotonic_ns() - ns;
    if (age_ns > kOldestStamp_ns || age_ns < -kMostAhead_ns) return {};
    return ns;
}

struct Received {
    std::array<std::uint8_t, 1536> bytes;
    std::size_t size = 0;
    int interface_number = 0;  // 0: the kernel did not say
    std::optional<timespec> stamp;
    std::optional<std::uint32_t> send;  // from the error queue: which send the stamp is of
};

void read_control(msghdr& message, Received& r) {
    for (cmsghdr* c = CMSG_FIRSTHDR(&message); c; c = CMSG_NXTHDR(&message, c)) {
        if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SCM_TIMESTAMPING) {
            scm_timestamping stamps;
            std::memcpy(&stamps, CMSG_DATA(c), sizeof stamps);
            r.stamp = stamps.ts[0];  // the software stamp
        } else if (c->cmsg_level == IPPROTO_IP && c->cmsg_type == IP_PKTINFO) {
            in_pktinfo info;
            std::memcpy(&info, CMSG_DATA(c), sizeof info);
            r.interface_number = info.ipi_ifindex;
        } else if ((c->cmsg_level == IPPROTO_IP && c->cmsg_type == IP_RECVERR) ||
                   (c->cmsg_level == SOL_PACKET && c->cmsg_type == PACKET_TX_TIMESTAMP)) {
            sock_extended_err error;
            std::memcpy(&error, CMSG_DATA(c), sizeof error);
            if (error.ee_origin == SO_EE_ORIGIN_TIMESTAMPING && error.ee_info == SCM_TSTAMP_SND)
                r.send = error.ee_data;
        }
    }
}

// Returns false when there is none.
bool receive_with_stamp(int socket, int flags, Received& r) {
    alignas(cmsghdr) std::array<char, 512> control;
    iovec where{r.bytes.data(), r.bytes.size()};
    msghdr message{};
    message.msg_iov = &where;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t got = recvmsg(socket, &message, MSG_DONTWAIT | flags);
    if (got < 0) return false;
    r.size = static_cast<std::size_t>(got);
    r.interface_number = 0;
    r.stamp.reset();
    r.send.reset();
    read_control(message, r);
    return true;
}

// A card's second address may have a name of its own, as eth0:1; only the card matters.
int index_of_interface(const NetInterface& net) {
    return static_cast<int>(if_nametoindex(net.name.substr(0, net.name.find(':')).c_str()));
}

}  // namespace

PtpSockets::PtpSockets(const NetInterface& net, PtpTransport transport)
    : transport_(transport), interface_number_(index_of_interface(net)) {
    if (interface_number_ == 0) refuse_socket("PTP on " + net.name, "");
    if (transport == PtpTransport::kUdp)
        open_udp_sockets(net);
    else
        open_packet_socket(net);
}

void PtpSockets::open_udp_sockets(const NetInterface& net) {
    event_ = open_group(net, interface_number_, kEventPort);
    general_ = open_group(net, interface_number_, kGeneralPort);
}

void PtpSockets::open_packet_socket(const NetInterface& net) {
    const std::string what = "PTP on " + net.name + ": Ethernet packets";
    event_ = Fd(::socket(AF_PACKET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, htons(kEtherType)));
    if (!event_) refuse_socket(what, "they need the right CAP_NET_RAW (sudo setcap cap_net_raw+ep HILCAM)");
    sockaddr_ll own{};
    own.sll_family = AF_PACKET;
    own.sll_protocol = htons(kEtherType);
    own.sll_ifindex = interface_number_;
    if (bind(event_.get(), reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0) refuse_socket(what, "");
    packet_mreq membership{};
    membership.mr_ifindex = interface_number_;
    membership.mr_type = PACKET_MR_MULTICAST;
    membership.mr_alen = kGroupMac.size();
    std::copy(kGroupMac.begin(), kGroupMac.end(), membership.mr_address);
    set_option(event_, SOL_PACKET, PACKET_ADD_MEMBERSHIP, membership, what);
    ask_for_stamps(event_, what);
}

void PtpSockets::wait(const Fd& wakeup, std::int64_t timeout_ns) {
    // poll() ignores negative descriptors.
    watched_ = {{{wakeup.get(), POLLIN, 0}, {event_.get(), POLLIN, 0}, {general_.get(), POLLIN, 0}}};
    const timespec timeout = timespec_of(std::max<std::int64_t>(0, timeout_ns));
    ppoll(watched_.data(), watched_.size(), &timeout, nullptr);
    if (watched_[0].revents) drain(wakeup);
}

void PtpSockets::take_departures(const Listener& listener) {
    Received r;
    while (receive_with_stamp(event_.get(), MSG_ERRQUEUE, r)) {
        if (!r.send || *r.send + 1 != sends_ || !r.stamp) continue;
        if (const auto departure_ns = monotonic_of_stamp(*r.stamp)) listener.sent(*departure_ns);
    }
}

void PtpSockets::take(const Listener& listener) {
    if (watched_[1].revents & POLLERR) take_departures(listener);
    Received r;
    for (const Fd* socket : {&event_, &general_}) {
        for (int n = 0; *socket && n < kAtOnce && receive_with_stamp(socket->get(), 0, r); ++n) {
            // Other programs' membership of the group brings datagrams of other interfaces, too.
            if (r.interface_number != 0 && r.interface_number != interface_number_) continue;
            std::optional<std::int64_t> arrival_ns;
            if (r.stamp) arrival_ns = monotonic_of_stamp(*r.stamp);
            listener.received({r.bytes.data(), std::min(r.size, r.bytes.size())}, arrival_ns);
        }
    }
}

bool PtpSockets::send(std::span<const std::uint8_t> message) noexcept {
    ssize_t sent = -1;
    if (transport_ == PtpTransport::kUdp) {
        const sockaddr_in to = socket_address(kGroup, kEventPort);
        sent = sendto(event_.get(), message.data(), message.size(), MSG_DONTWAIT,
                      reinterpret_cast<const sockaddr*>(&to), sizeof to);
    } else {
        sockaddr_ll to{};
        to.sll_family = AF_PACKET;
        to.sll_protocol = htons(kEtherType);
        to.sll_ifindex = interface_number_;
        to.sll_halen = kGroupMac.size();
        std::copy(kGroupMac.begin(), kGroupMac.end(), to.sll_addr);
        sent = sendto(event_.get(), message.data(), message.size(), MSG_DONTWAIT,
                      reinterpret_cast<const sockaddr*>(&to), sizeof to);
    }
    if (sent < 0) return false;
    ++sends_;
    return true;
}

}  // namespace hilcam
