#pragma once
// A segment of an SPK: the state of a body relative to a centre over a span of time, by one of the data types
// of NAIF, "SPK Required Reading".
//
// Types: 1, 21 (modified difference arrays), 2, 3, 14, 20 (Chebyshev polynomials), 5 (two-body motion between
// states), 8, 9, 12, 13, 18, 19 (interpolated states), 10 (two-line elements), 15, 17 (precessing elements).
// Each type's source has the details from NAIF's document.

#include <memory>
#include <string>

#include "io/naif/daf_file.h"
#include "render/sky/bodies.h"

namespace hilcam {

// A segment's summary, with NAIF's codes. Times are TDB seconds since J2000; both ends belong to the span.
struct SpkSummary {
    int target = 0, center = 0, frame = 0, type = 0;
    double start_et_s = 0, stop_et_s = 0;
    std::string where;  // file and segment, for messages

    bool covers(double et_s) const { return start_et_s <= et_s && et_s <= stop_et_s; }
};
SpkSummary spk_summary(const DafFile& file, const DafArray& array);

class SpkSegment {
  public:
    explicit SpkSegment(SpkSummary about) : about_(std::move(about)) {}
    virtual ~SpkSegment() = default;

    const SpkSummary& about() const { return about_; }
    // Returns the geometric state relative to the centre in the segment's frame, at a time inside the span;
    // always finite. Loop: no allocation.
    virtual StateVector at(double et_s) const = 0;

  private:
    SpkSummary about_;
};

// Reads a segment. Throws InputError that names it when its type is none of those above, or when its numbers
// are inconsistent.
std::unique_ptr<SpkSegment> load_spk_segment(const DafFile& file, const DafArray& array);

}  // namespace hilcam
