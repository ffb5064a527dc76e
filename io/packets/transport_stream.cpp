// Packets as a byte stream over TCP or a Unix socket. Space packets say themselves how long they are, SpaceWire
// packets have their length before them, so nothing else goes between them. A client that connects during a run
// gets the stream from the begin of a frame on.

#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <list>
#include <optional>

#include "io/packets/packet_stream_peer.h"
#include "io/packets/packet_transport.h"
#include "io/packets/packets_config.h"
#include "io/system/allow_list.h"
#include "io/system/fd.h"
#include "io/system/monotonic.h"
#include "io/system/tcp_peer.h"
#include "io/system/unix_socket_file.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

constexpr std::int64_t kConnectAgain_ns = 500'000'000;
constexpr int kConnect_ms = 200;

std::string name_of(const PacketsConfig& c) {
    const std::string kind = c.is_server() ? "_server " : " ";
    return c.has_path() ? "unix" + kind + c.path.string()
                        : "tcp" + kind + c.address + ":" + std::to_string(c.port);
}
int patience_ms_of(const PacketsConfig& c) { return static_cast<int>(1e3 * c.patience_s); }

// Returns a connected socket, or none with errno set.
Fd connected(int family, const sockaddr* to, socklen_t size) {
    Fd socket(::socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (!socket || connect(socket.get(), to, size) == 0) return socket;
    if (errno != EINPROGRESS) return {};
    pollfd watched{socket.get(), POLLOUT, 0};
    int reason = ETIMEDOUT;
    socklen_t length = sizeof reason;
    if (poll(&watched, 1, kConnect_ms) > 0) getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &reason, &length);
    if (reason == 0) return socket;
    errno = reason;
    return {};
}

class PacketStreamClient : public PacketTransport {
  public:
    explicit PacketStreamClient(const PacketsConfig& c) : PacketTransport(name_of(c)), config_(c) {}

    void open() override { next_try_ns_ = 0; }

    bool begin_frame(std::uint64_t) override {
        if (!peer_ && monotonic_ns() >= next_try_ns_) try_to_connect();
        return peer_.has_value();
    }
    bool send(std::span<const std::uint8_t> bytes) override {
        if (peer_ && !peer_->send(bytes)) lose();
        return peer_.has_value();
    }
    Outcome end_frame() override {
        if (peer_ && !peer_->flush()) lose();
        return peer_ ? Outcome::kDelivered : Outcome::kDropped;
    }
    void close() noexcept override { peer_.reset(); }

  private:
    void try_to_connect() {
        Fd socket = config_.has_path() ? to_path() : to_address();
        if (!socket) {
            if (!told_)
                note(std::string("nobody is there (") + std::strerror(errno) +
                         "); tried again each half second",
                     true);
            told_ = true;
            next_try_ns_ = monotonic_ns() + kConnectAgain_ns;
            return;
        }
        const int on = 1;
        if (!config_.has_path()) setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
        peer_.emplace(std::move(socket), "the receiver", patience_ms_of(config_));
        if (told_) note("connected", false);
        told_ = false;
    }
    Fd to_path() const {
        const sockaddr_un to = unix_address(config_.path.string());
        return connected(AF_UNIX, reinterpret_cast<const sockaddr*>(&to), sizeof to);
    }
    Fd to_address() const {
        const sockaddr_in to = socket_address(parse_ipv4(config_.address, "outputs.packets.address"),
                                              static_cast<std::uint16_t>(config_.port));
        return connected(AF_INET, reinterpret_cast<const sockaddr*>(&to), sizeof to);
    }
    void lose() {
        note(peer_->name() + " " + peer_->reason(), true);
        told_ = true;
        peer_.reset();
        next_try_ns_ = monotonic_ns() + kConnectAgain_ns;
    }

    PacketsConfig config_;
    std::optional<PacketStreamPeer> peer_;
    std::int64_t next_try_ns_ = 0;
    bool told_ = false;  // that nobody is there
};

class PacketStreamServer : public PacketTransport {
  public:
    explicit PacketStreamServer(const PacketsConfig& c) : PacketTransport(name_of(c)), config_(c) {
        if (c.is_tcp_server()) allow_.emplace(c.allow, c.address, "outputs.packets");
    }

    void open() override {
        listener_ = config_.has_path() ? file_.listen(config_.path.string(), SOCK_STREAM)
                                       : listen_tcp(parse_ipv4(config_.address, "outputs.packets.address"),
                                                    static_cast<std::uint16_t>(config_.port));
    }
    bool begin_frame(std::uint64_t) override {
        while (accept_one()) {
        }
        return !peers_.empty();
    }
    bool send(std::span<const std::uint8_t> bytes) override {
        keep([bytes](PacketStreamPeer& peer) { return peer.send(bytes); });
        return !peers_.empty();
    }
    Outcome end_frame() override {
        keep([](PacketStreamPeer& peer) { return peer.flush(); });
        return peers_.empty() ? Outcome::kDropped : Outcome::kDelivered;
    }
    void close() noexcept override {
        peers_.clear();
        listener_.reset();
        file_.remove();
    }

  private:
    // Keeps the peers for which take() is true.
    template <class Take>
    void keep(const Take& take) {
        peers_.remove_if([&](PacketStreamPeer& peer) {
            if (take(peer)) return false;
            note(peer.name() + " " + peer.reason(), true);
            return true;
        });
    }
    bool accept_one() {
        Fd socket(accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
        if (!socket) return false;
        std::string peer = "a client";
        if (allow_ && !admit_tcp(*allow_, socket.get(), peer)) {
            note(peer + " may not connect (outputs.packets.allow)", true);
            return true;
        }
        if (peers_.size() >= static_cast<std::size_t>(config_.clients)) {
            note(peer + " is one too many (outputs.packets.clients)", true);
            return true;
        }
        note(peer + " is connected", false);
        peers_.emplace_back(std::move(socket), peer, patience_ms_of(config_));
        return true;
    }

    PacketsConfig config_;
    std::optional<AllowList> allow_;
    UnixSocketFile file_;
    Fd listener_;
    std::list<PacketStreamPeer> peers_;
};

}  // namespace

std::unique_ptr<PacketTransport> make_stream_client(const PacketsConfig& config) {
    return std::make_unique<PacketStreamClient>(config);
}
std::unique_ptr<PacketTransport> make_stream_server(const PacketsConfig& config) {
    return std::make_unique<PacketStreamServer>(config);
}

}  // namespace hilcam
