#pragma once
// A world with its origin in free space: the Sun's place in it, and the visible bodies of the Solar System.

#include "emulator/scenario/app_config.h"

namespace hilcam {

// For `origin: {kind: free}`, takes the Sun's place from the keys of `sun`, and hides bodies without a
// `visible` key. Throws KeyError for keys of `sun` that are missing, contradictory, or not used with another
// origin, and for a nadir without a named body.
void settle_free_space(ScenarioConfig& scenario);

}  // namespace hilcam
