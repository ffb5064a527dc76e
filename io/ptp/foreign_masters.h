#pragma once
// The masters that are heard, and the best of them: the part of the best master clock algorithm that a
// slave-only clock with one port needs (IEEE 1588-2008, 9.3).
//
// A master counts when two of its Announce messages came within four of its intervals (9.3.2.4.4), and until
// none has come for three (announceReceiptTimeout, 9.2.6.11). An Announce is ignored when it came over more
// than 254 boundary clocks (9.3.2.5 d), is of an alternate master, or names this clock as its grandmaster.
// Owner thread.

#include <array>
#include <cstdint>
#include <optional>

#include "io/ptp/ptp_message.h"

namespace hilcam {

struct ForeignMaster {
    ptp::PortIdentity sender;
    std::uint16_t flags = 0;
    ptp::Announce announce;
    std::int64_t received_ns = 0, interval_ns = 0;
    bool qualified = false;
};

// True when `a` is a better master than `b`: the data set comparison of 9.3.4 (figures 27 and 28).
bool is_better(const ForeignMaster& a, const ForeignMaster& b);

class ForeignMasters {
  public:
    // More masters than networks have. When all places are taken, a new one takes that of a master that does
    // not count, or none.
    static constexpr std::size_t kMost = 8;

    explicit ForeignMasters(std::uint64_t own_clock) : own_clock_(own_clock) {}
    void take(const ptp::Message& announce, std::int64_t now_ns);
    void expire(std::int64_t now_ns);
    void clear() { masters_ = {}; }
    // Returns null when no master counts.
    const ForeignMaster* best() const;
    // Returns when the next one expires; INT64_MAX: none.
    std::int64_t wake_ns() const;

  private:
    static std::int64_t end_of(const ForeignMaster& m) { return m.received_ns + 3 * m.interval_ns; }

    std::uint64_t own_clock_;
    std::array<std::optional<ForeignMaster>, kMost> masters_{};
};

}  // namespace hilcam
