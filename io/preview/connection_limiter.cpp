#include "io/preview/connection_limiter.h"

#include <arpa/inet.h>
#include <dirent.h>
#include <linux/tcp.h>
#include <netinet/in.h>
#include <pthread.h>
#include <sys/socket.h>

#include <array>
#include <charconv>
#include <cstddef>
#include <cstring>
#include <memory>
#include <string_view>
#include <vector>

#include "io/preview/preview_slot.h"

namespace hilcam {
namespace {

constexpr std::chrono::milliseconds kInterval{50};

struct Connection {
    int fd;
    std::uint32_t peer_address;  // host order, as the port
    std::uint16_t peer_port;
    std::uint64_t received_bytes;
};

// The library hides its sockets, so they are found among the process's descriptors: connected TCP sockets
// with our local port.
bool find_connection(int fd, std::uint16_t port, Connection& found) {
    sockaddr_in here{}, there{};
    socklen_t length = sizeof here;
    if (getsockname(fd, reinterpret_cast<sockaddr*>(&here), &length) != 0) return false;
    if (here.sin_family != AF_INET || ntohs(here.sin_port) != port) return false;
    length = sizeof there;
    if (getpeername(fd, reinterpret_cast<sockaddr*>(&there), &length) != 0) return false;
    tcp_info info{};
    length = sizeof info;
    if (getsockopt(fd, IPPROTO_TCP, TCP_INFO, &info, &length) != 0) return false;
    found = {fd, ntohl(there.sin_addr.s_addr), ntohs(there.sin_port), info.tcpi_bytes_received};
    return true;
}

// True when the headers of a request are complete: its client waits for a worker and is not slow.
bool has_request_unread(int fd) {
    std::array<char, 8192> bytes;
    const ssize_t size = recv(fd, bytes.data(), bytes.size(), MSG_PEEK | MSG_DONTWAIT);
    return size > 0 && std::string_view(bytes.data(), static_cast<std::size_t>(size)).find("\r\n\r\n") !=
                           std::string_view::npos;
}

std::vector<Connection> connections_of(std::uint16_t port) {
    std::vector<Connection> all;
    const std::unique_ptr<DIR, int (*)(DIR*)> folder(opendir("/proc/self/fd"), closedir);
    if (!folder) return all;
    while (const dirent* entry = readdir(folder.get())) {
        int fd = -1;
        const char* name = static_cast<const char*>(entry->d_name);
        Connection found{};
        if (std::from_chars(name, name + std::strlen(name), fd).ec == std::errc{} &&
            find_connection(fd, port, found))
            all.push_back(found);
    }
    return all;
}

}  // namespace

void ConnectionLimiter::start(std::uint16_t port, const Limits& limits) {
    port_ = port, limits_ = limits;
    stopping_ = ending_ = false;
    first_seen_.clear();
    heard_.clear();
    thread_ = std::thread([this] {
        pthread_setname_np(pthread_self(), kPreviewThreadName);
        run();
    });
}

void ConnectionLimiter::end_all() {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    changed_.notify_all();
}

void ConnectionLimiter::stop() noexcept {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void ConnectionLimiter::heard(const std::string& address, int port) {
    in_addr parsed{};
    if (inet_pton(AF_INET, address.c_str(), &parsed) != 1) return;
    const std::lock_guard lock(mutex_);
    heard_.emplace(ntohl(parsed.s_addr), static_cast<std::uint16_t>(port));
}

void ConnectionLimiter::run() {
    std::unique_lock lock(mutex_);
    while (!stopping_) {
        look();
        changed_.wait_for(lock, kInterval, [&] { return stopping_; });
    }
}

void ConnectionLimiter::look() {
    const auto now = Clock::now();
    const std::vector<Connection> connections = connections_of(port_);
    const auto patience =
        connections.size() > limits_.crowd ? limits_.request_age_in_crowd : limits_.request_age;
    std::map<Peer, Clock::time_point> still_there;
    std::set<Peer> still_heard;
    for (const Connection& c : connections) {
        const Peer peer{c.peer_address, c.peer_port};
        const auto known = first_seen_.find(peer);
        const auto since = known == first_seen_.end() ? now : known->second;
        still_there.emplace(peer, since);
        // A worker that has read a request may report it late, so a request seen complete before counts as
        // heard.
        const bool heard = heard_.contains(peer) || has_request_unread(c.fd);
        if (heard) still_heard.insert(peer);
        const bool dawdles = !heard && now - since > patience;
        // The library notices the end of the connection and closes it.
        if (ending_ || dawdles || now - since > limits_.age || c.received_bytes > limits_.received_bytes ||
            !limits_.allows(c.peer_address))
            shutdown(c.fd, SHUT_RDWR);
    }
    first_seen_ = std::move(still_there);
    heard_ = std::move(still_heard);
}

}  // namespace hilcam
