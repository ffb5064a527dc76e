#pragma once
// The instants that kernels know something at.

#include <vector>

#include "emulator/motion/motion_source.h"
#include "io/spice/kernel_frames.h"

namespace hilcam {

class SpiceCoverage {
  public:
    SpiceCoverage() = default;
    SpiceCoverage(const std::vector<EtSpan>& spans, const EphemerisTime& time);

    bool empty() const { return spans_.empty(); }
    // Loop, both.
    MotionValidity validity(TimeTai time) const;
    // Returns SPICE's time of a known instant: inside the span, whatever the rounding to nanoseconds did.
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
