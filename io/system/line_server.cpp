#include "io/system/line_server.h"

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <span>

#include "io/system/tcp_peer.h"

namespace hilcam {

LineServer::LineServer(const LineServerSetup& setup)
    : setup_(setup),
      allow_(setup.allow, setup.address, setup.key),
      address_(parse_ipv4(setup.address, setup.key + ".address")) {}

void LineServer::start() {
    listener_ = listen_tcp(address_, setup_.port);
    stopping_ = false;
    thread_ = std::thread([this] { run(); });
}

void LineServer::stop() noexcept {
    if (!thread_.joinable()) return;
    stopping_ = true;
    wake(wakeup_);
    thread_.join();
    listener_.reset();
}

void LineServer::notify(std::string_view line) {
    const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(line.data()),
                                              line.size());
    bool waiting = false;
    {
        const std::lock_guard lock(mutex_);
        for (Client& client : clients_) {
            if (client.gone) continue;
            if (!client.output.put(bytes)) {
                cut_off_.fetch_add(1, std::memory_order_relaxed);
                client.gone = true;
            } else {
                client.gone = !client.output.flush(client.socket.get());
            }
            waiting |= client.gone || !client.output.empty();
        }
    }
    // The thread then also waits for room in the sockets.
    if (waiting) wake(wakeup_);
}

void LineServer::run() {
    std::vector<pollfd> watched;
    while (true) {
        watched.assign({{wakeup_.get(), POLLIN, 0}, {listener_.get(), POLLIN, 0}});
        {
            const std::lock_guard lock(mutex_);
            for (const Client& client : clients_)
                watched.push_back({client.socket.get(),
                                   static_cast<short>(POLLIN | (client.output.empty() ? 0 : POLLOUT)), 0});
        }
        if (poll(watched.data(), watched.size(), -1) < 0) continue;
        if (stopping_) break;
        if (watched[0].revents) drain(wakeup_);
        {
            // The list is unchanged since: only this thread adds and removes clients.
            const std::lock_guard lock(mutex_);
            auto at = watched.begin() + 2;
            for (Client& client : clients_) serve(client, (at++)->revents);
            drop_gone();
        }
        if (watched[1].revents) accept_client();
    }
    const std::lock_guard lock(mutex_);
    for (Client& client : clients_) {
        client.output.flush(client.socket.get());
        client.gone = true;
    }
    drop_gone();
}

// Reads from a client and discards the bytes.
void LineServer::serve(Client& client, short events) {
    if (events & POLLOUT) client.gone |= !client.output.flush(client.socket.get());
    if (!(events & ~POLLOUT)) return;
    std::array<std::uint8_t, 4096> ignored;
    const ssize_t got = recv(client.socket.get(), ignored.data(), ignored.size(), MSG_DONTWAIT);
    client.gone |= got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR);
}

void LineServer::accept_client() {
    Fd socket(accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!socket) {
        // Without a free descriptor, accept() would fail again at once: pause.
        if (errno != EAGAIN && errno != ECONNABORTED) poll(nullptr, 0, 10);
        return;
    }
    const std::lock_guard lock(mutex_);
    std::string peer;
    if (clients_.size() >= setup_.max_clients || !admit_tcp(allow_, socket.get(), peer)) return;
    clients_.emplace_back().socket = std::move(socket);
    connected_.store(clients_.size(), std::memory_order_relaxed);
}

void LineServer::drop_gone() {
    clients_.remove_if([](const Client& client) { return client.gone; });
    connected_.store(clients_.size(), std::memory_order_relaxed);
}

}  // namespace hilcam
