#include "emulator/motion/spice_coverage.h"

#include <algorithm>

#include "emulator/motion/ephemeris.h"

namespace hilcam {

SpiceCoverage::SpiceCoverage(const std::vector<EtSpan>& spans, const EphemerisTime& time) : time_(time) {
    for (const EtSpan& s : spans) spans_.push_back({time.tai(s.start_s), time.tai(s.stop_s), s});
}

MotionValidity SpiceCoverage::validity(TimeTai time) const {
    if (spans_.empty()) return {MotionStatus::kGap, time};
    // The same as validity_of() in ephemeris.h, by binary search, because attitudes may have many thousand
    // spans.
    const auto after = std::partition_point(spans_.begin(), spans_.end(),
                                            [&](const Span& s) { return s.usable_stop < time; });
    if (after == spans_.end()) return {MotionStatus::kAfter, spans_.back().usable_stop};
    if (after->usable_start <= time) return {MotionStatus::kOk, time};
    if (after == spans_.begin()) return {MotionStatus::kBefore, after->usable_start};
    const TimeTai before = (after - 1)->usable_stop;
    return {MotionStatus::kGap, time - before <= after->usable_start - time ? before : after->usable_start};
}

double SpiceCoverage::et_s(TimeTai time) const {
    const double et_s = time_.et_s(time);
    const auto after = std::partition_point(spans_.begin(), spans_.end(),
                                            [&](const Span& s) { return s.usable_stop < time; });
    if (after == spans_.end() || after->usable_start > time) return et_s;
    return std::clamp(et_s, after->et.start_s, after->et.stop_s);
}

}  // namespace hilcam
