#pragma once
// Interpolates ephemerides (io/files/oem_file.h, io/files/aem_file.h) as their messages say: LINEAR, LAGRANGE
// or HERMITE of a degree, from the samples around the instant, never across segments.
//
// States: Hermite's polynomial passes through positions and velocities, and its derivative is the velocity.
// Lagrange uses two polynomials, for positions and for velocities. These are SPICE's types 13 and 9. A
// message without a method gets Hermite of degree 7, or lower if it has fewer samples.
//
// Attitudes: polynomials pass through the quaternions' components, and the result is normalised. LINEAR, also
// the default, turns at a constant rate from sample to sample.

#include <vector>

#include "emulator/motion/motion_source.h"
#include "io/files/aem_file.h"
#include "io/files/oem_file.h"

namespace hilcam {

// Interpolates in the segment's own frame, about its centre. The instant must be in the usable span. Loop.
StateVector interpolate_state(const OemSegment& segment, TimeTai time);
// An attitude relative to the segment's reference frame. Loop.
struct ReferenceAttitude {
    Quat reference_from_body;
    Vec3d rate_body_rad_s;
};
ReferenceAttitude interpolate_attitude(const AemSegment& segment, TimeTai time);

// Compares a time with usable spans, which must be in rising order.
template <class Segment>
MotionValidity validity_of(const std::vector<Segment>& segments, TimeTai time) {
    for (std::size_t i = 0; i < segments.size(); ++i) {
        if (segments[i].usable_stop < time) continue;
        if (segments[i].usable_start <= time) return {MotionStatus::kOk, time};
        if (i == 0) return {MotionStatus::kBefore, segments[i].usable_start};
        const TimeTai before = segments[i - 1].usable_stop, after = segments[i].usable_start;
        return {MotionStatus::kGap, time - before <= after - time ? before : after};
    }
    return {MotionStatus::kAfter, segments.back().usable_stop};
}
// Returns the segment for a valid instant. At a boundary that two segments share, returns the later one.
template <class Segment>
const Segment& segment_of(const std::vector<Segment>& segments, TimeTai time) {
    std::size_t i = segments.size() - 1;
    while (i > 0 && time < segments[i].usable_start) --i;
    return segments[i];
}
// Throws InputError that names the first gap.
template <class Segment>
void require_no_gap(const std::vector<Segment>& segments, const std::string& name) {
    for (std::size_t i = 1; i < segments.size(); ++i)
        if (segments[i - 1].usable_stop < segments[i].usable_start)
            throw InputError(name + ":" + std::to_string(segments[i].line) + ": a gap from " +
                             format_utc(segments[i - 1].usable_stop) + " to " +
                             format_utc(segments[i].usable_start) +
                             "; accepted: segments whose usable spans meet (or outside: hold)");
}

}  // namespace hilcam
