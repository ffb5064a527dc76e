#pragma once
// One connection of a stream transport. Packets are gathered and leave in pieces of up to 64 KiB, so that
// small packets do not cost a system call each. What the peer sends is discarded.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/system/fd.h"

namespace hilcam {

// Returns "has read nothing for 5 s".
std::string has_read_nothing_for(int ms);

class PacketStreamPeer {
  public:
    // socket: connected, non-blocking.
    PacketStreamPeer(Fd socket, std::string name, int patience_ms)
        : socket_(std::move(socket)), name_(std::move(name)), patience_ms_(patience_ms) {}

    // False when the peer is gone, or has taken nothing for as long as the patience lasts.
    bool send(std::span<const std::uint8_t> bytes);
    bool flush();
    const std::string& name() const { return name_; }
    // Returns why send() or flush() was false: "has read nothing for 5 s".
    const std::string& reason() const { return reason_; }

  private:
    bool wait_for_room();
    void discard_input();

    Fd socket_;
    std::string name_;
    int patience_ms_;
    std::vector<std::uint8_t> waiting_;
    std::string reason_;
};

}  // namespace hilcam
