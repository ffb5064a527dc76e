#pragma once
// Applies faults on demand (fault.h) to a stream's packets and time stamps. Only what is sent is damaged:
// frames kept for resends stay intact.

#include <cstdint>
#include <optional>

#include "io/contract/fault.h"
#include "io/ptp/clock_line.h"

namespace hilcam {

struct PacketFate {
    bool lost = false;
    bool twice = false;
    bool corrupt = false;                  // one byte of the payload inverted
    std::optional<std::int64_t> delay_ns;  // sent this much later
    std::int64_t id_error = 0;             // added to the packet id
    std::size_t cut_bytes = 0;             // removed from the end
};
// Returns the fate of a packet that is sent for the first time.
PacketFate fate_of_packet(FaultBoard& faults, std::uint64_t frame, std::uint32_t id, std::uint32_t trailer);
// Returns the fate of a resent packet: `lost` means refused.
PacketFate fate_of_resend(FaultBoard& faults, std::uint64_t frame, std::uint32_t id);

// Packet ids 0 to `last` in sending order: rising, except for pairs that are swapped.
class PacketOrder {
  public:
    explicit PacketOrder(std::uint32_t last) : last_(last) {}
    bool done() const { return next_ > last_ && !held_; }
    std::uint32_t next(FaultBoard& faults, std::uint64_t frame);

  private:
    std::uint32_t next_ = 0, last_;
    std::optional<std::uint32_t> held_;
};

// The device's clock, true and as faults make it. One thread.
class StampClock {
  public:
    // Returns the time stamp of an instant, which `clock` gives without faults. faults_seen: gets the bits of
    // the faults that struck.
    std::uint64_t stamp(FaultBoard& faults, std::uint64_t frame, std::int64_t monotonic_ns,
                        const ClockLine& clock, std::uint64_t& faults_seen);

  private:
    std::uint64_t last_ = 0;
};

}  // namespace hilcam
