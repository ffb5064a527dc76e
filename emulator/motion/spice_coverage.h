#pragma once
// The time spans that kernels cover.

#include <vector>

#include "emulator/motion/motion_source.h"
#include "io/spice/kernel_frames.h"

namespace hilcam {

class SpiceCoverage {
  public:
    SpiceCoverage() = default;
    SpiceCoverage(const std::vector<EtSpan>& spans, const EphemerisTime& time);

    bool empty() const { return spans_.empty(); }
    // Loop; so is et_s().
    MotionValidity validity(TimeTai time) const;
    // Returns SPICE's time of a covered instant; it stays inside the span whatever the rounding to
    // nanoseconds.
    double et_s(TimeTai time) const;

  private:
    struct Span {
        TimeTai usable_start, usable_stop;
        EtSpan et;
    };
    std::vector<Span> spans_;
    EphemerisTime time_;
};

}  // namespace hilcam
