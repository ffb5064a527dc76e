#pragma once
// Finds what a run would be refused on this machine: a missing interface, a folder that cannot be written.

#include <string>
#include <vector>

#include "emulator/scenario/app_config.h"

namespace hilcam {

// Returns one line for each. scenario: as one of its cameras has it. To try a folder, makes a temporary
// folder in it, or in its nearest existing parent, and removes that again.
std::vector<std::string> machine_warnings(const ScenarioConfig& scenario);

}  // namespace hilcam
