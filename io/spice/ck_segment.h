#pragma once
// A segment of a CK: the attitude of a structure (a spacecraft, an instrument) in a reference frame over a
// span of clock ticks, by one of the data types of NAIF, "C-kernel Required Reading".
//
// Types: 1 (instants), 2 (constant rates), 3 (rotation at a constant rate between instants), 4 (Chebyshev
// polynomials), 5 (interpolation). NAIF's quaternions take vectors from the reference to the structure.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/naif/daf_file.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// A segment's summary, with NAIF's codes. Both ends of the span belong to it.
struct CkSummary {
    int structure = 0, frame = 0, type = 0;
    bool has_rates = false;
    double start_ticks = 0, stop_ticks = 0;
    std::string where;
};
CkSummary ck_summary(const DafFile& file, const DafArray& array);

// The attitude of a structure and its rate of change. For instants (type 1) it is the kernel's rate, or 0.
struct CkPointing {
    Quat reference_from_structure;
    Vec3d rate_reference_rad_s;
};

// A span of ticks; both ends belong to it.
struct TickSpan {
    double start = 0, stop = 0;
};

class CkSegment {
  public:
    explicit CkSegment(CkSummary about) : about_(std::move(about)) {}
    virtual ~CkSegment() = default;

    const CkSummary& about() const { return about_; }
    // Returns the spans with a known attitude, in order; an instant is a span of length 0.
    virtual std::vector<TickSpan> spans() const = 0;
    // Returns the attitude; nothing outside those spans. seconds_per_tick: the clock's, at that time. Loop:
    // no allocation.
    virtual std::optional<CkPointing> at(double ticks, double seconds_per_tick) const = 0;

  private:
    CkSummary about_;
};

// Reads a segment. Throws InputError that names it when its type is none of those above, or when its numbers
// are inconsistent.
std::unique_ptr<CkSegment> load_ck_segment(const DafFile& file, const DafArray& array);

}  // namespace hilcam
