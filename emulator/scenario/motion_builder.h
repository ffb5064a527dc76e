#pragma once
// Builds the sources of motion from a scenario's `motion` sections.

#include "emulator/motion/motion_source.h"
#include "emulator/scenario/app_config.h"

namespace hilcam {

// Reads every file the scenario's motions name, and checks them at the scenario's start. Throws InputError.
MotionSources load_motion_sources(const ScenarioConfig& scenario);

}  // namespace hilcam
