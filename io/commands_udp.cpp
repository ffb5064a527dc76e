#include "io/commands_udp.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>

#include <algorithm>
#include <cstring>

#include "io/command_codec.h"

namespace hilcam {
namespace {

std::int64_t now_ns(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

// The kernel stamps datagrams with CLOCK_REALTIME; the age moves it to CLOCK_MONOTONIC. Without a stamp: now.
std::int64_t arrival_of(msghdr& message) {
    const std::int64_t monotonic_ns = now_ns(CLOCK_MONOTONIC);
    for (cmsghdr* c = CMSG_FIRSTHDR(&message); c; c = CMSG_NXTHDR(&message, c)) {
        if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SCM_TIMESTAMPNS) continue;
        timespec stamp{};
        std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
        const std::int64_t age_ns =
            now_ns(CLOCK_REALTIME) - (std::int64_t{stamp.tv_sec} * 1'000'000'000 + stamp.tv_nsec);
        // A step of the wall clock between the two readings must not move the arrival by more than it can be
        // old.
        return monotonic_ns - std::clamp<std::int64_t>(age_ns, 0, 1'000'000'000);
    }
    return monotonic_ns;
}

}  // namespace

Fields fields(UdpCommandConfig& c) {
    return {
        text("address", c.address, "IPv4 address of this machine to listen on"),
        integer("port", c.port, {1, 65535}, "UDP port to listen on"),
    };
}

UdpCommandReceiver::UdpCommandReceiver(const UdpCommandConfig& config, CommandHandler& handler)
    : config_(config), handler_(handler) {}

void UdpCommandReceiver::start() {
    socket_ = open_udp(parse_ipv4(config_.address, "commands.udp.address"),
                       static_cast<std::uint16_t>(config_.port));
    const int on = 1;
    setsockopt(socket_.get(), SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
    wakeup_ = open_wakeup();
    thread_ = std::thread([this] { run(); });
}

void UdpCommandReceiver::stop() noexcept {
    if (!thread_.joinable()) return;
    wake(wakeup_);
    thread_.join();
    socket_.reset();
}

CommandReport UdpCommandReceiver::report() const { return {received_.load(), refused_.load(), lost_.load()}; }

void UdpCommandReceiver::run() {
    std::array<std::uint8_t, 65536> buffer;
    pollfd watched[] = {{socket_.get(), POLLIN, 0}, {wakeup_.get(), POLLIN, 0}};
    while (true) {
        if (poll(watched, 2, -1) < 0) continue;
        if (watched[1].revents) return;
        sockaddr_in sender{};
        iovec io{buffer.data(), buffer.size()};
        alignas(cmsghdr) std::array<char, 128> control;
        msghdr message{&sender, sizeof sender, &io, 1, control.data(), control.size(), 0};
        const ssize_t size = recvmsg(socket_.get(), &message, MSG_DONTWAIT);
        if (size >= 0)
            take_datagram({buffer.data(), static_cast<std::size_t>(size)}, arrival_of(message), sender);
    }
}

void UdpCommandReceiver::take_datagram(std::span<const std::uint8_t> datagram, std::int64_t arrival_ns,
                                       const sockaddr_in& sender) {
    do {
        std::size_t size = datagram.size();
        if (size >= SpacePacketHeader::kBytes)
            size = std::min(size, read_packet_header(datagram).total_bytes());
        take_packet(datagram.first(size), arrival_ns, sender);
        datagram = datagram.subspan(size);
    } while (!datagram.empty());
}

void UdpCommandReceiver::take_packet(std::span<const std::uint8_t> packet, std::int64_t arrival_ns,
                                     const sockaddr_in& sender) {
    const DecodedCommand decoded = decode_command(packet);
    Acknowledgement answer;
    answer.function = decoded.function;
    answer.sequence = decoded.sequence;
    answer.status = decoded.status;
    answer.reason = decoded.reason;
    if (decoded.status == CommandStatus::kAccepted) {
        count_lost(decoded.sequence, sender);
        answer.status = handler_.handle(decoded.command, decoded.sequence, arrival_ns);
        if (answer.status != CommandStatus::kAccepted) answer.reason = name_of(answer.status);
        if (const auto* ping = std::get_if<PingCommand>(&decoded.command)) answer.token = ping->token;
    }
    received_.fetch_add(1);
    if (answer.status != CommandStatus::kAccepted) refused_.fetch_add(1);
    answer.simulated_time = handler_.now();
    std::array<std::uint8_t, kMostAcknowledgeBytes> bytes;
    const std::size_t size = encode_acknowledgement(answer, acknowledgements_++, bytes);
    sendto(socket_.get(), bytes.data(), size, MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&sender),
           sizeof sender);
}

// Gaps in a sender's 32-bit sequence. A sender that starts anew (a smaller number) is taken as new; the
// sixteen senders seen last are remembered.
void UdpCommandReceiver::count_lost(std::uint32_t sequence, const sockaddr_in& sender) {
    const std::uint64_t endpoint = std::uint64_t{sender.sin_addr.s_addr} << 16 | sender.sin_port;
    for (Sender& known : senders_) {
        if (known.endpoint != endpoint) continue;
        if (sequence > known.next) lost_.fetch_add(sequence - known.next);
        known.next = sequence + 1;
        return;
    }
    senders_[next_sender_] = {endpoint, sequence + 1};
    next_sender_ = (next_sender_ + 1) % senders_.size();
}

}  // namespace hilcam
