#pragma once
// `hilcam check`: is the scenario right, what will be computed and why, what kind of camera is it.

#include <string>

#include "emulator/app_config.h"

namespace hilcam {

// Loads everything the scenario names; the text says what was found. Throws InputError, DeviceError.
std::string check_scenario(const ScenarioConfig& scenario);

}  // namespace hilcam
