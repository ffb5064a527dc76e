#pragma once
// Makes a ladder for the governor (quality_ladder.h) of what `hilcam tradeoff` has measured: the settings
// that are faster than the scenario's own and that none of those beats in both time and error, best first.
// Only such settings count whose every change may be made from one frame to the next.

#include <string>

#include "emulator/tradeoff/tradeoff.h"

namespace hilcam {

// A file that the scenario's `loop:` can name, with frame_budget_ms as it was asked for; empty when no
// setting is faster than the scenario's own.
std::string ladder_yaml(const Tradeoff& tradeoff);

}  // namespace hilcam
