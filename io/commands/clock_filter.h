#pragma once
// Estimates simulated time at a sender, from exchanges of clock readings (ClockCommand and its answer).
//
// An exchange has four instants, as in NTP: the command leaves at t1 and the answer comes at t4, on the
// sender's clock; the command comes at t2 and the answer leaves at t3, on the machine's CLOCK_MONOTONIC. RFC
// 5905 (2010), section 8:
//    offset = ((t2 - t1) + (t3 - t4)) / 2      machine's clock - sender's
//    delay  = (t4 - t1) - (t3 - t2)
// The true offset is within delay / 2 of this, however asymmetric the path. Of the last kSamples exchanges,
// the one with the least error is used (section 10, the clock filter). Its error grows by 15 ppm of its age,
// the drift between two undisciplined quartz clocks (section 7.2, PHI).
//
// The offset refers to the machine's clock, not to simulated time, so that scale and pauses do not disturb
// it. Each answer says how simulated time continues; that holds until somebody changes the clock.
//
// Pure, no allocation. Owner thread.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "io/contract/command.h"

namespace hilcam {

struct ClockExchange {
    std::int64_t sent_ns = 0;      // t1
    std::int64_t received_ns = 0;  // t4
    ClockReading reading;          // t2, t3, and the simulated time
};

class ClockFilter {
  public:
    static constexpr std::size_t kSamples = 8;  // RFC 5905's NSTAGE
    static constexpr double kDrift = 15e-6;

    // Takes an exchange. Returns false, and changes nothing, for an impossible one: an answer before its
    // question.
    bool take(const ClockExchange& exchange);

    struct Estimate {
        std::int64_t offset_ns = 0;  // machine's clock - sender's
        std::int64_t delay_ns = 0;   // there and back
        double error_ns = 0;         // upper bound
    };
    // Returns the estimate at an instant of the sender's clock; nothing before the first exchange.
    std::optional<Estimate> estimate(std::int64_t sender_ns) const;
    // Returns simulated time at that instant, extrapolated from the newest answer. Its error is `scale` times
    // error_ns.
    std::optional<TimeTai> simulated_at(std::int64_t sender_ns) const;

  private:
    struct Sample {
        std::int64_t offset_ns, delay_ns, received_ns;
    };
    std::array<Sample, kSamples> samples_{};
    std::size_t count_ = 0;  // total of exchanges taken
    ClockReading newest_;
};

// Returns simulated = min(departure + scale (monotonic - departure_monotonic), stands_at).
TimeTai simulated_at(const ClockReading& reading, std::int64_t monotonic_ns);

}  // namespace hilcam
