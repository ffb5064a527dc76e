#include "tools/flight_software_example/link.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>

namespace flight {
namespace {

// A frame in lockstep may take a slow machine seconds.
constexpr std::int64_t kPatience_ns = 10'000'000'000;
constexpr int kPings = 8;

}  // namespace

std::int64_t monotonic_ns() {
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

Link::Link(const std::string& endpoint) : endpoint_(endpoint) {
    const std::size_t colon = std::min(endpoint.rfind(':'), endpoint.size());
    const char* const end = endpoint.data() + endpoint.size();
    std::uint16_t port = 0;
    const auto [at, error] = std::from_chars(std::min(endpoint.data() + colon + 1, end), end, port);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    if (error != std::errc{} || at != end || port == 0 ||
        inet_pton(AF_INET, endpoint.substr(0, colon).c_str(), &to.sin_addr) != 1)
        throw std::runtime_error("'" + endpoint + "': accepted: an IPv4 ADDRESS:PORT");
    socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (socket_ < 0 || connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) {
        const std::string why = std::strerror(errno);
        if (socket_ >= 0) close(socket_);
        throw std::runtime_error(endpoint + ": " + why);
    }
}

Link::~Link() { close(socket_); }

void Link::set_pose(const hilcam_pose& pose) {
    ask(hilcam_encode_pose(&envelope_, &pose, bytes_, sizeof bytes_));
}

void Link::expose(std::int64_t exposure_mid_tai_ns) {
    hilcam_expose expose{};
    expose.frames = 1;
    expose.time_tai_ns = exposure_mid_tai_ns;
    ask(hilcam_encode_expose(&envelope_, &expose, bytes_, sizeof bytes_));
}

hilcam_acknowledgement Link::ping() { return ask(hilcam_encode_ping(&envelope_, 1, bytes_, sizeof bytes_)); }

void Link::post_pose(const hilcam_pose& pose) {
    hilcam_acknowledgement answer;
    const std::size_t size = hilcam_encode_pose(&envelope_, &pose, bytes_, sizeof bytes_);
    ::send(socket_, bytes_, size, 0);
    ++envelope_.sequence;
    while (receive(0, answer)) {
    }
    if (heard_ns_ != 0 && monotonic_ns() - heard_ns_ > kPatience_ns) throw silent();
}

std::int64_t Link::simulated_offset_ns() {
    std::int64_t offset_ns = 0, quickest_ns = kPatience_ns;
    for (int i = 0; i < kPings; ++i) {
        const std::int64_t sent_ns = monotonic_ns();
        const std::int64_t simulated_ns = ping().simulated_tai_ns;
        const std::int64_t trip_ns = monotonic_ns() - sent_ns;
        if (trip_ns >= quickest_ns) continue;
        quickest_ns = trip_ns;
        offset_ns = simulated_ns - (sent_ns + trip_ns / 2);  // the clock was read half a round trip ago
    }
    return offset_ns;
}

// Sends what stands in bytes_ and waits; answers of earlier posts are passed over.
hilcam_acknowledgement Link::ask(std::size_t bytes) {
    const std::uint32_t sequence = envelope_.sequence++;
    ::send(socket_, bytes_, bytes, 0);
    const std::int64_t until_ns = monotonic_ns() + kPatience_ns;
    hilcam_acknowledgement answer;
    while (monotonic_ns() < until_ns)
        if (receive(100, answer) && answer.sequence == sequence) return answer;
    throw silent();
}

std::runtime_error Link::silent() const {
    return std::runtime_error(endpoint_ + " does not answer; is 'hilcam run' up and listening there?");
}

// An acknowledgement; one that refuses throws.
bool Link::receive(int timeout_ms, hilcam_acknowledgement& answer) {
    std::uint8_t bytes[HILCAM_MOST_PACKET_BYTES];
    pollfd watched{socket_, POLLIN, 0};
    if (poll(&watched, 1, timeout_ms) <= 0) return false;
    const ssize_t got = recv(socket_, bytes, sizeof bytes, MSG_DONTWAIT);
    hilcam_packet packet;
    if (got <= 0 || hilcam_decode(HILCAM_DIALECT_OWN, bytes, static_cast<std::size_t>(got), &packet) !=
                        HILCAM_KIND_ACKNOWLEDGEMENT)
        return false;
    answer = packet.as.acknowledgement;
    heard_ns_ = monotonic_ns();
    if (answer.status != HILCAM_ACCEPTED)
        throw std::runtime_error(endpoint_ + ": " + hilcam_status_name(answer.status) + ": " + answer.reason);
    return true;
}

}  // namespace flight
