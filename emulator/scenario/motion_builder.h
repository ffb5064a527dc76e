#pragma once
// Builds the sources of motion from a scenario's `motion` sections.

#include "emulator/motion/motion_source.h"
#include "emulator/scenario/app_config.h"

namespace hilcam {

// Reads every file that the scenario's motions name, and evaluates them at the scenario's start. Throws
// InputError.
MotionSources load_motion_sources(const ScenarioConfig& scenario);
// Returns remarks about contents of orbit and attitude messages that are not used, each with the motion's
// key. Throws InputError as above.
std::vector<std::string> motion_warnings(const ScenarioConfig& scenario);

}  // namespace hilcam
