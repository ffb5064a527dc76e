#pragma once
// The data types of SPK segments, each group in a spk_*.cpp. Each function takes a segment's words, checks
// them, and throws InputError.

#include <vector>

#include "io/spice/spk_segment.h"

namespace hilcam {

inline constexpr double kKilometre_m = 1000;

// Types 2, 3, 14, 20.
std::unique_ptr<SpkSegment> make_spk_chebyshev(const SpkSummary& about, std::vector<double> words);
// Type 5.
std::unique_ptr<SpkSegment> make_spk_two_body(const SpkSummary& about, std::vector<double> words);
// Types 8, 9, 12, 13, 18, 19.
std::unique_ptr<SpkSegment> make_spk_discrete(const SpkSummary& about, std::vector<double> words);
// Type 10.
std::unique_ptr<SpkSegment> make_spk_two_line(const SpkSummary& about, std::vector<double> words);
// Types 15, 17.
std::unique_ptr<SpkSegment> make_spk_elements(const SpkSummary& about, std::vector<double> words);
// Types 1, 21.
std::unique_ptr<SpkSegment> make_spk_differences(const SpkSummary& about, std::vector<double> words);

}  // namespace hilcam
