#pragma once
// What a scenario says that has no effect, or hides everything: it may be meant, so it is no error, but
// whoever runs it is told.

#include <string>
#include <vector>

#include "emulator/scenario/app_config.h"

namespace hilcam {

// A line each: lockstep in which nobody can ask for a frame, faults that no output or port can show, a camera
// that begins inside a body. Throws InputError where the scenario's motions cannot be had.
std::vector<std::string> warnings_of(const ScenarioConfig& scenario);

}  // namespace hilcam
