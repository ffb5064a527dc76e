#include "io/commands/commands_udp.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>

#include "io/system/datagram_arrival.h"
#include "io/system/monotonic.h"

namespace hilcam {
namespace {

constexpr std::size_t kMaxDatagramBytes = 65536;

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
    ask_for_arrivals(socket_.get());
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
    peers_.forget_all();
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
    CommandStation::Sender& sender = peers_.at(from, arrival_ns);
    const CommandStation::Answer answer = [&](std::span<const std::uint8_t> packet) { send(packet, from); };
    if (size == 0) return station_.refuse_empty(sender, answer);
    stream_.filled(static_cast<std::size_t>(size));
    station_.take_all(stream_, arrival_ns, sender, answer);
}

void UdpCommandReceiver::send_telemetry() {
    peers_.forget_silent(monotonic_ns());
    Telemetry telemetry;
    while (telemetry_.take(telemetry))
        station_.notify(telemetry, [&](CommandStation::Sender& sender, std::span<const std::uint8_t> packet) {
            if (const sockaddr_in* to = peers_.address_of(sender)) send(packet, *to);
        });
}

void UdpCommandReceiver::send(std::span<const std::uint8_t> packet, const sockaddr_in& to) {
    sendto(socket_.get(), packet.data(), packet.size(), MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&to),
           sizeof to);
}

}  // namespace hilcam
