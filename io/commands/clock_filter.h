#pragma once
// A sender's estimate of the simulated time, from exchanges of clock readings (ClockCommand and its answer).
//
// Four instants of an exchange, as in NTP: t1 the command leaves and t4 the answer comes, by the sender's
// clock; t2 the command comes and t3 the answer leaves, by the machine's CLOCK_MONOTONIC. RFC 5905 (2010),
// section 8:
//     offset = ((t2 - t1) + (t3 - t4)) / 2      machine's clock - sender's
//     delay  = (t4 - t1) - (t3 - t2)
// The true offset lies within delay / 2 of that, however unequal the two ways are. Of the last kSamples the
// one with the least error counts (section 10, the clock filter); its error grows by 15 ppm of its age, what
// two undisciplined quartz clocks may drift apart (section 7.2, PHI).
//
// The offset is to the machine's clock and not to simulated time, because no scale and no pause touches it:
// how simulated time goes on from there is in each answer. It is known until somebody changes the clock.
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

    // False, and nothing is changed, for one that cannot be: an answer before its question.
    bool take(const ClockExchange& exchange);

    struct Estimate {
        std::int64_t offset_ns = 0;  // machine's clock - sender's
        std::int64_t delay_ns = 0;   // there and back
        double error_ns = 0;         // at the most
    };
    // Estimates at an instant of the sender's clock; there is no estimate before the first exchange.
    std::optional<Estimate> estimate(std::int64_t sender_ns) const;
    // The simulated time then, by the newest answer's way of going; it errs by `scale` times error_ns.
    std::optional<TimeTai> simulated_at(std::int64_t sender_ns) const;

  private:
    struct Sample {
        std::int64_t offset_ns, delay_ns, received_ns;
    };
    std::array<Sample, kSamples> samples_{};
    std::size_t count_ = 0;  // ever taken
    ClockReading newest_;
};

// simulated = min(departure + scale (monotonic - departure_monotonic), stands_at)
TimeTai simulated_at(const ClockReading& reading, std::int64_t monotonic_ns);

}  // namespace hilcam
