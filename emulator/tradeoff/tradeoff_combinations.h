#pragma once
// Finds which combinations of settings are worth a measurement, from what each knob does alone.

#include <cstddef>
#include <vector>

#include "emulator/tradeoff/tradeoff.h"

namespace hilcam {

// Combinations of choices in the order in which to measure them, so many at most; without those that differ
// from the scenario's own setting in one knob or none. settings: the scenario's own, then single ones.
//
// Of each knob there are its own value and those on its own front of time and error. Of all their
// combinations those come first that promise to be on the front of all: times are taken to multiply and mean
// squares of errors to add, each knob's share as it was alone. The promise sets the order only; what counts
// is measured.
std::vector<std::vector<std::size_t>> promising_combinations(const std::vector<Knob>& knobs,
                                                             const std::vector<MeasuredSetting>& settings,
                                                             std::size_t most);

}  // namespace hilcam
