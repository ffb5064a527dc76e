#pragma once
// A segment of an SPK: where a body is about a centre over a span of time, by one of the data types of NAIF, "SPK
// Required Reading".
//
// Types: 1, 21 (modified difference arrays), 2, 3, 14, 20 (Chebyshev polynomials), 5 (two bodies between states), 8, 9,
// 12, 13, 18, 19 (interpolated states), 10 (two-line elements), 15, 17 (elements that precess). What NAIF's document says of a type stands in that type's source.

#include <memory>
#include <string>

#include "io/naif/daf_file.h"
#include "render/sky/bodies.h"

namespace hilcam {

// A segment's summary. Codes are NAIF's; times are TDB seconds since J2000 and count at both ends.
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
    // Returns the geometric state about the centre in the segment's frame, at a time inside the span. Loop: no
    // allocation. Finite for a segment that could be made.
    virtual StateVector at(double et_s) const = 0;

  private:
    SpkSummary about_;
};

// Reads a segment. Throws InputError that names it when its type is none of those above or its numbers do not fit each
// other.
std::unique_ptr<SpkSegment> load_spk_segment(const DafFile& file, const DafArray& array);

}  // namespace hilcam
