#pragma once
// Some packets for one system call, with the damage that faults do to them. The frame's payload is neither
// copied nor changed: a corrupted byte is sent from a separate place.

#include <netinet/in.h>
#include <sys/socket.h>

#include <array>

#include "io/gige/stream/gige_packets.h"
#include "io/gige/stream/stream_faults.h"

namespace hilcam {

class PacketBatch {
  public:
    static constexpr std::size_t kMaxPackets = 32;

    // Removes the packets; further ones go to `to`.
    void begin(const sockaddr_in& to) { to_ = to, count_ = 0, bytes_ = 0; }
    bool full() const { return count_ == kMaxPackets; }
    // Adds a packet; the batch must not be full. fate: its damage is applied here, but not when and how often
    // it is sent.
    void add(const GigePacket& packet, const PacketFate& fate, bool extended);
    std::size_t count() const { return count_; }
    std::size_t bytes() const { return bytes_; }  // UDP and IP headers included
    const sockaddr_in& to() const { return to_; }

    // Returns how many packets the kernel did not accept: larger than the link's MTU with fragmentation off,
    // or no route to the destination. They are lost, as on a wire.
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
