#pragma once
// From a scenario's `motion` sections to the sources of motion.

#include "emulator/motion/motion_source.h"
#include "emulator/scenario/app_config.h"

namespace hilcam {

// Reads every file the scenario's motions name, and checks them at the scenario's start. Throws InputError.
MotionSources load_motion_sources(const ScenarioConfig& scenario);

}  // namespace hilcam
