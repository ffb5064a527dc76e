#pragma once
// Some packets for one system call, with the damage that faults do to them. The frame's payload is not
// copied, and not touched: a byte that is to be wrong goes out from a place of its own.

#include <netinet/in.h>
#include <sys/socket.h>

#include <array>

#include "io/gige/stream/gige_packets.h"
#include "io/gige/stream/stream_faults.h"

namespace hilcam {

class PacketBatch {
  public:
    static constexpr std::size_t kMaxPackets = 32;

    // Forgets the packets; those to come go to `to`.
    void begin(const sockaddr_in& to) { to_ = to, count_ = 0, bytes_ = 0; }
    bool full() const { return count_ == kMaxPackets; }
    // Must not be full. Damage as `fate` says, but for what concerns when and how often it is sent.
    void add(const GigePacket& packet, const PacketFate& fate, bool extended);
    std::size_t count() const { return count_; }
    std::size_t bytes() const { return bytes_; }  // UDP and IP headers included
    const sockaddr_in& to() const { return to_; }

    // Gives the number of packets that the kernel did not take: longer than the link's MTU and not to be
    // cut up, or no way to the destination. They are lost as on a wire.
    std::size_t send(int socket) noexcept;

  private:
    struct Message {
        GigePacket packet;
        std::uint8_t inverted = 0;
        std::array<iovec, 4> parts{};
    };
    std::array<Message, kMaxPackets> messages_;
    std::array<mmsghdr, kMaxPackets> headers_{};
    sockaddr_in to_{};
    std::size_t count_ = 0, bytes_ = 0;
};

}  // namespace hilcam
