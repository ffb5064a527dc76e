#pragma once
// Builds the sources of motion from a scenario's `motion` sections.

#include "emulator/motion/motion_source.h"
#include "emulator/scenario/app_config.h"

namespace hilcam {

// Reads every file the scenario's motions name, and checks them at the scenario's start. Throws InputError.
MotionSources load_motion_sources(const ScenarioConfig& scenario);
// Says, with the key of each motion, what its orbit and attitude messages have that is not used. Throws InputError as above.
std::vector<std::string> motion_warnings(const ScenarioConfig& scenario);

}  // namespace hilcam
