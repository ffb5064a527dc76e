#include "io/commands/commands_udp.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstring>

#include "io/system/monotonic.h"

namespace hilcam {
namespace {

constexpr std::size_t kMaxPeers = 16;
constexpr std::int64_t kSilence_ns = 60'000'000'000;
constexpr std::size_t kMaxDatagramBytes = 65536;

// Returns the arrival on CLOCK_MONOTONIC. The kernel stamps datagrams with CLOCK_REALTIME; the stamp's age
// converts it. Without a stamp, it is the present time.
std::int64_t arrival_of(msghdr& message) {
    const std::int64_t now_ns = monotonic_ns();
    for (cmsghdr* c = CMSG_FIRSTHDR(&message); c; c = CMSG_NXTHDR(&message, c)) {
        if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SCM_TIMESTAMPNS) continue;
        timespec stamp{}, wall{};
        std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
        clock_gettime(CLOCK_REALTIME, &wall);
        const std::int64_t age_ns =
            (std::int64_t{wall.tv_sec} - stamp.tv_sec) * 1'000'000'000 + wall.tv_nsec - stamp.tv_nsec;
        // The age is limited to a second, so that a step of the wall clock between the two readings shifts
        // the arrival by no more.
        return now_ns - std::clamp<std::int64_t>(age_ns, 0, 1'000'000'000);
    }
    return now_ns;
}

std::string text_of(const sockaddr_in& a) {
    return format_ipv4(ntohl(a.sin_addr.s_addr)) + ":" + std::to_string(ntohs(a.sin_port));
}

}  // namespace

Fields fields(UdpCommandConfig& c) {
    Fields list = {
        text("address", c.address, "IPv4 address of this machine to listen on"),
        integer("port", c.port, {1, 65535}, "UDP port to listen on"),
        allow_field(c.allow),
    };
    add_fields(c.dialect, list);
    return list;
}

void validate(const UdpCommandConfig& c) {
    validate(c.dialect);
    AllowList(c.allow, c.address, "commands.udp");
}

UdpCommandReceiver::UdpCommandReceiver(const UdpCommandConfig& config, CommandHandler& handler)
    : config_(config),
      allow_(config.allow, config.address, "commands.udp"),
      station_(handler, config.dialect),
      stream_(station_.make_stream(kMaxDatagramBytes)) {}

std::string UdpCommandReceiver::name() const {
    return "udp " + config_.address + ":" + std::to_string(config_.port);
}

void UdpCommandReceiver::start() {
    socket_ = open_udp(parse_ipv4(config_.address, "commands.udp.address"),
                       static_cast<std::uint16_t>(config_.port));
    const int on = 1;
    setsockopt(socket_.get(), SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
    stopping_ = false;
    thread_ = std::thread([this] { run(); });
}

void UdpCommandReceiver::stop() noexcept {
    if (!thread_.joinable()) return;
    stopping_ = true;
    wake(wakeup_);
    thread_.join();
    socket_.reset();
}

void UdpCommandReceiver::notify(const Telemetry& telemetry) noexcept {
    if (telemetry_.put(telemetry)) wake(wakeup_);
}

void UdpCommandReceiver::run() {
    pollfd watched[] = {{socket_.get(), POLLIN, 0}, {wakeup_.get(), POLLIN, 0}};
    while (true) {
        if (poll(watched, 2, -1) < 0) continue;
        if (stopping_) break;
        if (watched[0].revents) receive();
        if (watched[1].revents) {
            drain(wakeup_);
            send_telemetry();
        }
    }
    for (Peer& peer : peers_) station_.close(*peer.sender);
    peers_.clear();
}

void UdpCommandReceiver::receive() {
    sockaddr_in from{};
    const std::span<std::uint8_t> room = stream_.room();
    iovec io{room.data(), room.size()};
    alignas(cmsghdr) std::array<char, 128> control;
    msghdr message{&from, sizeof from, &io, 1, control.data(), control.size(), 0};
    const ssize_t size = recvmsg(socket_.get(), &message, MSG_DONTWAIT);
    if (size < 0) return;
    if (!allow_.allows(ntohl(from.sin_addr.s_addr))) return station_.count_stranger();
    const std::int64_t arrival_ns = arrival_of(message);
    Peer& peer = peer_of(from, arrival_ns);
    const CommandStation::Answer answer = [&](std::span<const std::uint8_t> packet) { send(packet, from); };
    if (size == 0) return station_.refuse_empty(*peer.sender, answer);
    stream_.filled(static_cast<std::size_t>(size));
    station_.take_all(stream_, arrival_ns, *peer.sender, answer);
}

// Returns the sender at an address. A new one replaces the one that was silent for longest.
UdpCommandReceiver::Peer& UdpCommandReceiver::peer_of(const sockaddr_in& address, std::int64_t now_ns) {
    forget_silent(now_ns);
    const auto known = std::find_if(peers_.begin(), peers_.end(), [&](const Peer& p) {
        return p.address.sin_addr.s_addr == address.sin_addr.s_addr && p.address.sin_port == address.sin_port;
    });
    if (known != peers_.end()) {
        peers_.splice(peers_.end(), peers_, known);
    } else {
        if (peers_.size() == kMaxPeers) {
            station_.close(*peers_.front().sender);
            peers_.pop_front();
        }
        peers_.push_back({address, &station_.open(text_of(address)), now_ns});
    }
    peers_.back().heard_ns = now_ns;
    return peers_.back();
}

void UdpCommandReceiver::forget_silent(std::int64_t now_ns) {
    while (!peers_.empty() && now_ns - peers_.front().heard_ns > kSilence_ns) {
        station_.close(*peers_.front().sender);
        peers_.pop_front();
    }
}

void UdpCommandReceiver::send_telemetry() {
    forget_silent(monotonic_ns());
    Telemetry telemetry;
    while (telemetry_.take(telemetry))
        station_.notify(telemetry, [&](CommandStation::Sender& sender, std::span<const std::uint8_t> packet) {
            for (const Peer& peer : peers_)
                if (peer.sender == &sender) send(packet, peer.address);
        });
}

void UdpCommandReceiver::send(std::span<const std::uint8_t> packet, const sockaddr_in& to) {
    sendto(socket_.get(), packet.data(), packet.size(), MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&to),
           sizeof to);
}

}  // namespace hilcam
