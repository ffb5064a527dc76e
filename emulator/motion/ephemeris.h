#pragma once
// Interpolation of the segments of ephemerides (io/files/oem_file.h, io/files/aem_file.h) as their messages
// say: LINEAR, LAGRANGE or HERMITE of a degree, from the samples around the instant, never across segments.
//
// States: Hermite's polynomial goes through positions and velocities and its derivative is the velocity;
// Lagrange's are two, through positions and through velocities, as SPICE's types 13 and 9. A message that
// does not say gets Hermite of degree 7, or of what it has samples for. Attitudes: polynomials through the
// quaternions' components, normalised; LINEAR, and a message that does not say, turns at a constant rate from
// sample to sample.

#include <vector>

#include "emulator/motion/motion_source.h"
#include "io/files/aem_file.h"
#include "io/files/oem_file.h"

namespace hilcam {

// Interpolates in the segment's own frame, about its centre. The instant lies in the usable span. Loop.
StateVector interpolate_state(const OemSegment& segment, TimeTai time);
// The attitude against the segment's reference frame. Loop.
struct ReferenceAttitude {
    Quat reference_from_body;
    Vec3d rate_body_rad_s;
};
ReferenceAttitude interpolate_attitude(const AemSegment& segment, TimeTai time);

// Finds where a time stands among usable spans, which rise.
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
// The segment of a valid instant; at a shared end the later one, as what happened there is over.
template <class Segment>
const Segment& segment_of(const std::vector<Segment>& segments, TimeTai time) {
    std::size_t i = segments.size() - 1;
    while (i > 0 && time < segments[i].usable_start) --i;
    return segments[i];
}
// Throws InputError naming the first gap.
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
