#pragma once
// Checks that a laboratory's frames can be what their names say: counts, ranges of numbers, light where there
// should be none. Everything that is refused is an InputError of one line with what was found and accepted.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "emulator/clone/frame_set.h"

namespace hilcam {

// Refuses a set with the wrong series: no darks, fewer than two flats, too few frames, two gains.
void check_series(const FrameSet& frames);

// Facts about the numbers of a series.
struct NumberFacts {
    std::uint16_t most = 0, most_swapped = 0;  // swapped: with the two bytes exchanged
    std::uint16_t bits_used = 0;               // all numbers, combined by OR
    double zeros = 0, ends = 0;         // share of numbers that are 0, and that are the converter's end
    double step = 0, step_swapped = 0;  // mean difference between neighbours in a row
};
// Gathers the facts of a series, frame by frame.
class NumberSurvey {
  public:
    explicit NumberSurvey(int bits) : end_((1u << bits) - 1) {}
    void add(const DnImage& frame);
    NumberFacts facts() const;

  private:
    unsigned end_;
    NumberFacts facts_;
    double numbers_ = 0, steps_ = 0;
};
// Refuses numbers that are too large, shifted, byte-swapped, or 8-bit pictures of a camera with more bits.
// facts: in the order of the series.
void check_numbers(const FrameSet& frames, std::span<const NumberFacts> facts);

// The mean of a dark series, for check_darkness().
struct DarkMean {
    const FrameSeries* series = nullptr;
    double mean_dn = 0, uncertainty_dn = 0;
};
// Refuses darks of one temperature that saw light: a series that is not on the line of the others, or a rate
// of rise like that of the flats. flat_rate_dn_s: the slowest rise of a flat above the darks.
void check_darkness(std::span<const DarkMean> darks, double flat_rate_dn_s, int bits);

}  // namespace hilcam
