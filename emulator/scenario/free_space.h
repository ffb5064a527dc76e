#pragma once
// A world whose origin is in free space: where its Sun is, and what of the Solar System is shown.

#include "emulator/scenario/app_config.h"

namespace hilcam {

// Takes the Sun's place, for `origin: {kind: free}`, from the keys of `sun`, and leaves out the bodies whose
// `visible` is not given. Throws KeyError for keys of `sun` that are missing, that another origin does not
// read, or that say it twice, and for a nadir of no named body.
void settle_free_space(ScenarioConfig& scenario);

}  // namespace hilcam
