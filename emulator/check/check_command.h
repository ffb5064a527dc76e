#pragma once
// `hilcam check`: whether a scenario is right, what will be computed and why, and which properties a camera
// has.

#include <span>
#include <string>

#include "emulator/check/check_report.h"
#include "emulator/scenario/app_config.h"

namespace hilcam {

// Loads everything that the scenario names, camera after camera. camera: which one, from 1; 0: all. Rendered
// frames are discarded. Throws InputError, DeviceError.
CheckReport check_scenario(const ScenarioConfig& scenario, std::size_t camera = 0);

// True for a camera file, which the key pitch_um identifies.
bool is_camera_file(const std::filesystem::path& file);
struct Checked {
    std::string text;  // for people, or JSON
    bool has_warnings = false;
};
// Returns the camera's data sheet, preceded by probable mistakes in its file. Throws InputError.
Checked check_camera(const std::filesystem::path& file, std::span<const std::string> overrides,
                     bool json = false);

}  // namespace hilcam
