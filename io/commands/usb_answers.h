#pragma once
// Queues answers and telemetry for USB bulk transfers, and applies faults to them. Pure except for the fault
// board.

#include <cstdint>
#include <span>
#include <vector>

#include "io/contract/fault.h"

namespace hilcam {

class UsbAnswers {
  public:
    explicit UsbAnswers(FaultBoard& faults, std::size_t max_bytes = 256 * 1024)
        : faults_(faults), max_bytes_(max_bytes) {}

    // Queues a whole packet; false when the queue is full and the packet is dropped. Telemetry may fill half
    // of it.
    bool put(std::span<const std::uint8_t> packet, bool telemetry);
    // Gets the bytes of the next transfer; 0 when there is nothing to send or a fault withholds it. The
    // length is never a multiple of 64 bytes, and so of no bulk endpoint's packet size: every transfer ends
    // with a short packet and needs no empty one.
    std::size_t next(std::span<std::uint8_t> transfer);
    void clear();
    std::size_t bytes() const { return bytes_.size() - begin_; }

  private:
    FaultBoard& faults_;
    std::size_t max_bytes_;
    std::vector<std::uint8_t> bytes_;
    std::size_t begin_ = 0;
    std::uint64_t packets_ = 0, transfers_ = 0;
    bool second_half_ = false, stalled_ = false;
};

}  // namespace hilcam
