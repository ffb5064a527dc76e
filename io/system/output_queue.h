#pragma once
// A bounded queue of packets for which a client's socket has no room yet. The owner decides what happens when
// it is full.

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace hilcam {

class OutputQueue {
  public:
    // whole_packets: sends each packet with its own send(), as sockets with message boundaries require.
    explicit OutputQueue(std::size_t max_bytes, bool whole_packets = false)
        : max_bytes_(max_bytes), whole_packets_(whole_packets) {}

    // Returns false, and queues nothing, when the packet would exceed max_bytes.
    bool put(std::span<const std::uint8_t> packet);
    // Sends what the socket accepts, without waiting. Returns false when the connection is broken.
    bool flush(int socket);
    std::size_t bytes() const { return bytes_.size() - begin_; }
    bool empty() const { return bytes() == 0; }

  private:
    void advance(std::size_t sent);

    std::size_t max_bytes_;
    bool whole_packets_;
    std::vector<std::uint8_t> bytes_;
    std::deque<std::size_t> sizes_;  // packet sizes, if packets are sent whole
    std::size_t begin_ = 0;
};

}  // namespace hilcam
