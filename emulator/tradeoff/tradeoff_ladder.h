#pragma once
// Makes levels for the governor (quality_ladder.h) from the results of `hilcam tradeoff`: settings that are
// faster than the scenario's own and that no other of them beats in both time and error, best first. Only
// settings with changes that may happen between frames are used.

#include <string>

#include "emulator/tradeoff/tradeoff.h"

namespace hilcam {

// Returns a file that the scenario's `loop:` can name, with frame_budget_ms as requested; empty when no
// setting is faster than the scenario's own.
std::string ladder_yaml(const Tradeoff& tradeoff);

}  // namespace hilcam
