#pragma once
// Converts between a spacecraft's clock ticks and SPICE's time with an SCLK kernel of type 1 (NAIF, "SCLK
// Required Reading").
//
// The kernel has triples of ticks, a parallel time (TDB or TT) and the seconds per count of the clock's first
// field; between triples the clock runs at a constant rate. Ticks continue over resets ("encoded SCLK").

#include <vector>

#include "io/spice/ephemeris_time.h"

namespace hilcam {

class SpacecraftClock {
  public:
    // clock: NAIF's code of the clock, negative (the spacecraft's). Throws InputError when the pool has no
    // such clock, or one of another type.
    SpacecraftClock(const KernelPool& pool, int clock, const EphemerisTime& time);

    // Ticks may be fractional, as NAIF's continuous ticks. Before the first triple and after the last, the
    // clock runs at the adjacent rate. Loop, all.
    double ticks(double et_s) const;
    double et_s(double ticks) const;
    double seconds_per_tick(double et_s) const;

  private:
    struct Piece {
        double ticks, parallel_s, seconds_per_tick;
    };
    std::vector<Piece> pieces_;
    EphemerisTime time_;
    bool parallel_is_tt_ = false;

    double parallel_s(double et_s) const { return parallel_is_tt_ ? time_.tt_s(et_s) : et_s; }
    const Piece& piece_at(double parallel_s) const;
};

}  // namespace hilcam
