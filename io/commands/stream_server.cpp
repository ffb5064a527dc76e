#include "io/commands/stream_server.h"

#include <poll.h>
#include <sys/socket.h>

#include <cerrno>

#include "io/system/monotonic.h"

namespace hilcam {
namespace {

constexpr std::size_t kMaxQueuedBytes = 256 * 1024;
// Telemetry may fill half of the queue; the rest is for answers.
constexpr std::size_t kMaxTelemetryQueuedBytes = kMaxQueuedBytes / 2;

}  // namespace

StreamServer::StreamServer(StreamServerSetup setup, CommandHandler& handler, const DialectConfig& dialect)
    : setup_(std::move(setup)), station_(handler, dialect) {}

void StreamServer::start() {
    listener_ = setup_.listen();
    stopping_ = false;
    thread_ = std::thread([this] { run(); });
}

void StreamServer::stop() noexcept {
    if (!thread_.joinable()) return;
    stopping_ = true;
    wake(wakeup_);
    thread_.join();
    listener_.reset();
    setup_.closed();
}

void StreamServer::notify(const Telemetry& telemetry) noexcept {
    if (telemetry_.put(telemetry)) wake(wakeup_);
}

void StreamServer::run() {
    std::vector<pollfd> watched;
    while (true) {
        watched.assign({{wakeup_.get(), POLLIN, 0}, {listener_.get(), POLLIN, 0}});
        for (const Client& client : clients_)
            watched.push_back(
                {client.socket.get(), static_cast<short>(POLLIN | (client.output.empty() ? 0 : POLLOUT)), 0});
        if (poll(watched.data(), watched.size(), -1) < 0) continue;
        if (stopping_) break;
        // Clients accepted below come after those that were watched.
        auto at = watched.begin() + 2;
        for (Client& client : clients_) {
            const short what = (at++)->revents;
            if (what & POLLOUT) client.gone |= !client.output.flush(client.socket.get());
            if (what & ~POLLOUT) receive(client);
        }
        if (watched[0].revents) {
            drain(wakeup_);
            send_telemetry();
        }
        drop_gone();
        if (watched[1].revents) accept_client();
    }
    for (Client& client : clients_) client.gone = true;
    drop_gone();
}

void StreamServer::accept_client() {
    Fd socket(accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!socket) {
        // Without a free descriptor, accept() would fail again at once: pause.
        if (errno != EAGAIN && errno != ECONNABORTED) poll(nullptr, 0, 10);
        return;
    }
    std::string peer;
    if (clients_.size() >= setup_.max_clients || !setup_.admit(socket.get(), peer))
        return station_.count_stranger();
    CommandStation::Sender& sender = station_.open(peer);
    clients_.push_back({std::move(socket), sender, station_.make_stream(),
                        OutputQueue(kMaxQueuedBytes, setup_.whole_packets)});
    if (setup_.read_only) station_.subscribe(sender, {true, true});
}

void StreamServer::receive(Client& client) {
    const std::span<std::uint8_t> room = client.stream.room();
    const ssize_t got = recv(client.socket.get(), room.data(), room.size(), MSG_DONTWAIT);
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
    const std::int64_t arrival_ns = monotonic_ns();
    const CommandStation::Answer answer = [&](std::span<const std::uint8_t> p) { this->answer(client, p); };
    if (got <= 0) {
        if (got == 0) station_.take_all(client.stream, arrival_ns, client.sender, answer);
        client.output.flush(client.socket.get());
        client.gone = true;
        return;
    }
    if (setup_.read_only) return;
    client.stream.filled(static_cast<std::size_t>(got));
    if (setup_.whole_packets)
        station_.take_all(client.stream, arrival_ns, client.sender, answer);
    else
        station_.take(client.stream, arrival_ns, client.sender, answer);
    client.gone |= !client.output.flush(client.socket.get());
}

// Called with the station's lock held.
void StreamServer::answer(Client& client, std::span<const std::uint8_t> packet) {
    if (client.gone || client.output.put(packet)) return;
    client.cut_off = client.gone = true;
}

void StreamServer::send_telemetry() {
    Telemetry telemetry;
    while (telemetry_.take(telemetry))
        station_.notify(telemetry, [&](CommandStation::Sender& sender, std::span<const std::uint8_t> packet) {
            for (Client& client : clients_)
                if (&client.sender == &sender && client.output.bytes() < kMaxTelemetryQueuedBytes)
                    client.output.put(packet);
        });
    for (Client& client : clients_) client.gone |= !client.output.flush(client.socket.get());
}

void StreamServer::drop_gone() {
    for (auto client = clients_.begin(); client != clients_.end();) {
        if (!client->gone) {
            ++client;
            continue;
        }
        if (client->cut_off) station_.count_cut_off();
        station_.close(client->sender);
        client = clients_.erase(client);
    }
}

}  // namespace hilcam
