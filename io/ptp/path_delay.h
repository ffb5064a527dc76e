#pragma once
// The mean path delay between master and slave by delay request and response (IEEE 1588-2008, 11.3):
//     delay = ((t2 - t1) + (t4 - t3)) / 2
// t1: Sync left the master, t2: it arrived here, t3: Delay_Req left here, t4: it arrived there. t2 and t3 are
// kept on CLOCK_MONOTONIC, because their difference in the master's time depends on the rate, which the first
// samples do not know. Half of any asymmetry of the path remains as an error. The result is the median of
// the latest exchanges: a packet that waited in a queue does not move it. Owner thread.

#include <array>
#include <cstddef>
#include <cstdint>

namespace hilcam {

struct DelayExchange {
    std::int64_t t1_ns = 0, t2_monotonic_ns = 0;  // t1 with its corrections added
    std::int64_t t3_monotonic_ns = 0, t4_ns = 0;  // t4 with its correction taken off
};

class PathDelay {
  public:
    static constexpr std::size_t kKept = 16;

    void add(const DelayExchange& exchange);
    void clear() { count_ = 0; }
    bool known() const { return count_ > 0; }
    // master_rate: the gain of the master's clock over CLOCK_MONOTONIC, a ratio. Returns 0 before the first
    // exchange.
    std::int64_t median_ns(double master_rate) const;

  private:
    std::array<DelayExchange, kKept> exchanges_{};
    std::size_t count_ = 0;  // all that came; the latest kKept are there
};

}  // namespace hilcam
