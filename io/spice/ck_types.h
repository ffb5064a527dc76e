#pragma once
// The data types of CK segments, each in a ck_*.cpp. Each function takes a segment's words, checks them, and
// throws InputError.

#include <span>

#include "io/spice/ck_segment.h"
#include "io/spice/segment_words.h"

namespace hilcam {

// Types 1 and 3.
std::unique_ptr<CkSegment> make_ck_instants(const CkSummary& about, std::vector<double> words);
// Type 2.
std::unique_ptr<CkSegment> make_ck_constant_rates(const CkSummary& about, std::vector<double> words);
// Type 4.
std::unique_ptr<CkSegment> make_ck_chebyshev(const CkSummary& about, std::vector<double> words);
// Type 5.
std::unique_ptr<CkSegment> make_ck_interpolated(const CkSummary& about, std::vector<double> words);

// Returns NAIF's quaternion of four words, normalised, as the rotation from the structure to the reference.
// Segments with one of length 0 are refused when they are made.
inline Quat from_naif(std::span<const double> q) {
    return conjugate(normalized(Quat{q[0], q[1], q[2], q[3]}));
}

// Samples in time order, divided into intervals within which they may be interpolated (types 3 and 5).
class CkIntervals {
  public:
    // times: of the samples; starts: of the intervals, each the time of a sample. Throws InputError through
    // `words`.
    CkIntervals(const SegmentWords& words, std::span<const double> times, std::span<const double> starts);

    std::vector<TickSpan> spans(std::span<const double> times) const;
    // The samples [first, end) of the interval that contains a time; nothing when none does. Loop.
    struct Samples {
        std::size_t first = 0, end = 0;
    };
    std::optional<Samples> at(std::span<const double> times, double ticks) const;

  private:
    std::vector<std::size_t> firsts_;  // first sample of each interval, and the number of samples
};

}  // namespace hilcam
