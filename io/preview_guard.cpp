#include "io/preview_guard.h"

#include <dirent.h>
#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <charconv>
#include <cstddef>
#include <cstring>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace hilcam {
namespace {

constexpr std::chrono::milliseconds kInterval{50};

struct Connection {
    int fd;
    std::uint32_t peer_address;
    std::uint16_t peer_port;
    std::uint64_t received_bytes;
};

// The library keeps its sockets to itself, so they are found among the process's descriptors: TCP, connected,
// with our port at this end.
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
    found = {fd, there.sin_addr.s_addr, there.sin_port, info.tcpi_bytes_received};
    return true;
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

void ConnectionGuard::start(std::uint16_t port, const Limits& limits) {
    port_ = port, limits_ = limits;
    stopping_ = ending_ = false;
    thread_ = std::thread([this] { run(); });
}

void ConnectionGuard::end_all() {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    changed_.notify_all();
}

void ConnectionGuard::stop() noexcept {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void ConnectionGuard::run() {
    using Clock = std::chrono::steady_clock;
    using Peer = std::pair<std::uint32_t, std::uint16_t>;
    std::map<Peer, Clock::time_point> first_seen;
    std::unique_lock lock(mutex_);
    while (!stopping_) {
        const auto now = Clock::now();
        std::map<Peer, Clock::time_point> still_there;
        for (const Connection& c : connections_of(port_)) {
            const Peer peer{c.peer_address, c.peer_port};
            const auto known = first_seen.find(peer);
            const auto since = known == first_seen.end() ? now : known->second;
            still_there.emplace(peer, since);
            // The library sees the end of the connection and closes it.
            if (ending_ || now - since > limits_.age || c.received_bytes > limits_.received_bytes)
                shutdown(c.fd, SHUT_RDWR);
        }
        first_seen = std::move(still_there);
        changed_.wait_for(lock, kInterval, [&] { return stopping_; });
    }
}

}  // namespace hilcam
