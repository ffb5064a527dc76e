// Packets as UDP datagrams, one each. Nobody acknowledges them: what the network loses is lost, and hilcam
// does not know. All that comes back is ICMP's word that nobody listens.

#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

#include "io/packets/packet_transport.h"
#include "io/packets/packets_config.h"
#include "io/system/fd.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

class UdpTransport : public PacketTransport {
  public:
    explicit UdpTransport(const PacketsConfig& c)
        : PacketTransport("udp " + c.address + ":" + std::to_string(c.port)),
          to_(socket_address(parse_ipv4(c.address, "outputs.packets.address"),
                             static_cast<std::uint16_t>(c.port))),
          patience_ms_(static_cast<int>(1e3 * c.patience_s)) {}

    void open() override {
        socket_ = Fd(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
        if (!socket_) throw DeviceError(std::string("no UDP socket: ") + std::strerror(errno));
        const int on = 1;
        setsockopt(socket_.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
        if (connect(socket_.get(), reinterpret_cast<const sockaddr*>(&to_), sizeof to_) != 0)
            throw DeviceError("outputs.packets: " + name() + " cannot be reached: " + std::strerror(errno));
    }

    bool begin_frame(std::uint64_t frame) override {
        frame_ = frame;
        refused_ = false;
        int pending = 0;  // the answer to an earlier frame's last packet
        socklen_t size = sizeof pending;
        getsockopt(socket_.get(), SOL_SOCKET, SO_ERROR, &pending, &size);
        return true;
    }

    bool send(std::span<const std::uint8_t> bytes) override {
        while (::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL) < 0) {
            if (errno == EINTR) continue;
            // The answer to an earlier datagram: this one has not been sent yet.
            if (errno == ECONNREFUSED) {
                refused_ = true;
                continue;
            }
            if ((errno == EAGAIN || errno == ENOBUFS) && wait_for_room()) continue;
            tell_once(std::string("packets are lost: ") + std::strerror(errno));
            packets_lost_.add(frame_);
            break;
        }
        return true;
    }

    Outcome end_frame() override {
        if (refused_) {
            tell_once("nobody listens there; packets are sent all the same");
            return Outcome::kUnwanted;
        }
        told_ = false;
        return Outcome::kDelivered;
    }

    void close() noexcept override { socket_.reset(); }

  private:
    bool wait_for_room() const {
        pollfd watched{socket_.get(), POLLOUT, 0};
        return poll(&watched, 1, patience_ms_) > 0;
    }
    void tell_once(const std::string& text) {
        if (!told_) note(text, true);
        told_ = true;
    }

    sockaddr_in to_;
    int patience_ms_;
    Fd socket_;
    std::uint64_t frame_ = 0;
    bool refused_ = false;
    bool told_ = false;  // since the last frame without trouble
};

}  // namespace

std::unique_ptr<PacketTransport> make_udp_transport(const PacketsConfig& config) {
    return std::make_unique<UdpTransport>(config);
}

}  // namespace hilcam
