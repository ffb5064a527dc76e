#pragma once
// Finds what a run would refuse on this machine now: an interface that is not there, a folder that cannot be written.

#include <string>
#include <vector>

#include "emulator/scenario/app_config.h"

namespace hilcam {

// A line each. scenario: as one of its cameras has it. A folder is tried by making one in it, or in what holds it, and
// removing that.
std::vector<std::string> machine_warnings(const ScenarioConfig& scenario);

}  // namespace hilcam
