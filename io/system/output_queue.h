#pragma once
// Packets that a client's socket has no room for yet. Bounded; the owner decides what to do when it is full.

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace hilcam {

class OutputQueue {
  public:
    // `whole_packets`: one send() for each packet, as sockets with message boundaries want it.
    explicit OutputQueue(std::size_t max_bytes, bool whole_packets = false)
        : max_bytes_(max_bytes), whole_packets_(whole_packets) {}

    // False, and nothing is queued, when it would hold more than its most.
    bool put(std::span<const std::uint8_t> packet);
    // Sends what the socket takes, without waiting. False when the connection is broken.
    bool flush(int socket);
    std::size_t bytes() const { return bytes_.size() - begin_; }
    bool empty() const { return bytes() == 0; }

  private:
    void advance(std::size_t sent);

    std::size_t max_bytes_;
    bool whole_packets_;
    std::vector<std::uint8_t> bytes_;
    std::deque<std::size_t> sizes_;  // of packets, when they are sent whole
    std::size_t begin_ = 0;
};

}  // namespace hilcam
