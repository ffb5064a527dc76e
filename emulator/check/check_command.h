#pragma once
// `hilcam check`: is the scenario right, what will be computed and why, what kind of camera is it.

#include <span>
#include <string>

#include "emulator/scenario/app_config.h"

namespace hilcam {

// Loads everything the scenario names; the text says what was found. Throws InputError, DeviceError.
std::string check_scenario(const ScenarioConfig& scenario);

// A camera's file alone, told by its key pitch_um.
bool is_camera_file(const std::filesystem::path& file);
// Its data sheet. Throws InputError.
std::string check_camera(const std::filesystem::path& file, std::span<const std::string> overrides);

}  // namespace hilcam
