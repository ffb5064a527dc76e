#pragma once
// Predicts from single knobs which combinations of settings are worth measuring.

#include <cstddef>
#include <vector>

#include "emulator/tradeoff/tradeoff.h"

namespace hilcam {

// Returns combinations of choices in the order in which to measure them, at most `most`. Combinations that
// differ from the scenario's own setting in fewer than two knobs are left out. settings: the scenario's own,
// then settings with one changed knob.
//
// Of each knob, the scenario's value and those on the knob's own front of time and error are combined.
// Combinations that are predicted to be on the overall front come first. The prediction multiplies times and
// adds mean squares of errors, with each knob's contribution as it was alone. It only determines the order;
// results are measured.
std::vector<std::vector<std::size_t>> promising_combinations(const std::vector<Knob>& knobs,
                                                             const std::vector<MeasuredSetting>& settings,
                                                             std::size_t most);

}  // namespace hilcam
