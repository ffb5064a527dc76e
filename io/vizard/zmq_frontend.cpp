#include "io/vizard/zmq_frontend.h"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstring>
#include <functional>
#include <limits>

#include "io/system/net_interface.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// Returns the address for ZeroMQ's notation: an address, an interface's name, or * for all.
std::uint32_t address_named(const std::string& host) {
    in_addr numeric{};
    if (host == "*") return INADDR_ANY;
    if (inet_pton(AF_INET, host.c_str(), &numeric) == 1) return ntohl(numeric.s_addr);
    return find_interface(host).address;
}

Fd listen_at(const std::string& address) {
    constexpr std::string_view kScheme = "tcp://";
    const std::size_t colon = address.rfind(':');
    std::uint16_t port = 0;
    const char* const last = address.data() + address.size();
    const auto [end, error] = std::from_chars(address.data() + colon + 1, last, port);
    if (!address.starts_with(kScheme) || colon < kScheme.size() || error != std::errc{} || end != last ||
        port == 0)
        throw InputError("found " + in_quotes(address) + "; accepted: tcp://ADDRESS:PORT");
    return listen_tcp(address_named(address.substr(kScheme.size(), colon - kScheme.size())), port);
}

Fd connect_abstract(const std::string& name) {
    Fd fd(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_un to{};
    to.sun_family = AF_UNIX;
    if (name.size() + 1 > sizeof to.sun_path) return {};
    std::memcpy(to.sun_path + 1, name.data(), name.size());
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
    if (!fd || connect(fd.get(), reinterpret_cast<const sockaddr*>(&to), size) != 0) return {};
    return fd;
}

}  // namespace

void ZmqFrontend::start() {
    listener_ = listen_at(setup_.address);
    stopping_ = false;
    thread_ = std::thread([this] { run(); });
}

void ZmqFrontend::stop() noexcept {
    if (!thread_.joinable()) return;
    stopping_ = true;
    wake(wakeup_);
    thread_.join();
    drain(wakeup_);
    listener_.reset();
}

void ZmqFrontend::run() {
    std::vector<pollfd> watched;
    while (!stopping_) {
        watched.assign({{wakeup_.get(), POLLIN, 0}, {listener_.get(), POLLIN, 0}});
        // A connection is read while there is room, and written while there is something to write.
        const auto events = [](const Way& from, const Way& to) {
            return static_cast<short>((from.empty() ? POLLIN : 0) | (to.empty() ? 0 : POLLOUT));
        };
        for (const Connection& c : connections_) {
            watched.push_back({c.outer.get(), events(c.in, c.out), 0});
            watched.push_back({c.inner.get(), events(c.out, c.in), 0});
        }
        if (poll(watched.data(), watched.size(), -1) < 0) continue;
        // Connections accepted below come after those that were watched.
        auto at = watched.begin() + 2;
        for (Connection& c : connections_) {
            const short outer = (at++)->revents, inner = (at++)->revents;
            serve(c, outer, inner);
        }
        connections_.remove_if([](const Connection& c) { return c.gone; });
        if (watched[1].revents) accept_connection();
    }
    connections_.clear();
}

void ZmqFrontend::end(Connection& c, const std::string& why) {
    c.gone = true;
    setup_.ended(why);
}

std::size_t ZmqFrontend::peers() const {
    return static_cast<std::size_t>(
        std::count_if(connections_.begin(), connections_.end(), std::mem_fn(&Connection::is_peer)));
}

// The list begins with the oldest connection.
void ZmqFrontend::make_room_for_a_stranger() {
    if (connections_.size() - peers() < kMaxStrangers) return;
    connections_.erase(
        std::find_if_not(connections_.begin(), connections_.end(), std::mem_fn(&Connection::is_peer)));
    setup_.ended("its peer has said nothing, and others wait");
}

void ZmqFrontend::make_room_for_a_peer() {
    if (peers() <= setup_.max_peers) return;
    const auto last = [](const Connection& c) {
        return c.is_peer() ? c.last_message : std::numeric_limits<std::uint64_t>::max();
    };
    end(*std::min_element(connections_.begin(), connections_.end(),
                          [&](const Connection& a, const Connection& b) { return last(a) < last(b); }),
        "there are more than " + std::to_string(setup_.max_peers) + ", and it has been silent longest");
}

void ZmqFrontend::bound_memory() {
    std::uint64_t held = 0;
    for (const Connection& c : connections_) held += c.gone ? 0 : c.held_bytes();
    if (held <= setup_.max_held_bytes) return;
    const auto most = [](const Connection& c) { return c.gone ? 0 : c.held_bytes(); };
    end(*std::max_element(connections_.begin(), connections_.end(),
                          [&](const Connection& a, const Connection& b) { return most(a) < most(b); }),
        "all together sent more than " + std::to_string(setup_.max_held_bytes) +
            " bytes that wait for answers, and its peer the most");
}

void ZmqFrontend::accept_connection() {
    Fd outer(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (!outer) {
        // Without a free descriptor, accept() would fail again at once: pause.
        if (errno != EAGAIN && errno != ECONNABORTED) poll(nullptr, 0, 10);
        return;
    }
    make_room_for_a_stranger();
    Fd inner = connect_abstract(setup_.inner);
    if (!inner) return;
    const int yes = 1;  // pieces are passed on without delay
    setsockopt(outer.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    connections_.push_back({std::move(outer),
                            std::move(inner),
                            {},
                            {},
                            ZmtpMeter(setup_.limits),
                            ZmtpMeter(ZmtpMeter::kNoLimits)});
}

// A side that has ended is noticed only after all that it sent is passed on, because it is not read before.
void ZmqFrontend::serve(Connection& c, short outer_events, short inner_events) {
    if (c.gone) return;
    if (c.in.empty() && (outer_events & ~POLLOUT)) take_from_outside(c);
    if (c.out.empty() && (inner_events & ~POLLOUT)) take_from_inside(c);
    if (c.gone) return;
    c.gone |= !write_from(c.in, c.inner) || !write_from(c.out, c.outer);
    // A connection that cannot pass anything on any more would make poll() return at once, again and again.
    const bool stuck =
        (!c.in.empty() && (outer_events & POLLHUP)) || (!c.out.empty() && (inner_events & POLLHUP));
    c.gone |= stuck || ((outer_events | inner_events) & (POLLERR | POLLNVAL)) != 0;
}

void ZmqFrontend::take_from_outside(Connection& c) {
    const std::uint64_t messages = c.asked.messages();
    c.gone |= !read_into(c.in, c.outer);
    if (!c.asked.take(c.in.waiting()))
        return end(c, "its peer sends what is no ZMTP 3, or a message above " +
                          std::to_string(setup_.limits.bytes) + " bytes or " +
                          std::to_string(setup_.limits.parts) + " parts");
    if (c.asked.messages() > messages) {
        c.last_message = ++messages_;
        make_room_for_a_peer();
    }
    bound_memory();
}

void ZmqFrontend::take_from_inside(Connection& c) {
    c.gone |= !read_into(c.out, c.inner);
    c.answered.take(c.out.waiting());
    if (c.answered.messages() >= c.asked.messages())
        c.settled_bytes = c.asked.announced_bytes() - c.asked.unfinished_bytes();
}

// Returns false when the other side has ended.
bool ZmqFrontend::read_into(Way& way, const Fd& from) {
    const ssize_t got = recv(from.get(), way.bytes.data(), way.bytes.size(), MSG_DONTWAIT);
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) return true;
    if (got <= 0) return false;
    way.begin = 0;
    way.end = static_cast<std::size_t>(got);
    return true;
}

bool ZmqFrontend::write_from(Way& way, const Fd& to) {
    if (way.empty()) return true;
    const ssize_t sent =
        send(to.get(), way.bytes.data() + way.begin, way.end - way.begin, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent < 0) return errno == EAGAIN || errno == EINTR;
    way.begin += static_cast<std::size_t>(sent);
    return true;
}

}  // namespace hilcam
