#pragma once
// `hilcam check`: is the scenario right, what will be computed and why, what kind of camera is it.

#include <span>
#include <string>

#include "emulator/check/check_report.h"
#include "emulator/scenario/app_config.h"

namespace hilcam {

// Loads everything the scenario names, camera after camera. camera: the one to look at, from 1; 0: all.
// Nothing of what it renders is kept. Throws InputError, DeviceError.
CheckReport check_scenario(const ScenarioConfig& scenario, std::size_t camera = 0);

// A camera's file alone, told by its key pitch_um.
bool is_camera_file(const std::filesystem::path& file);
struct Checked {
    std::string text;  // for people, or JSON
    bool has_warnings = false;
};
// Its data sheet, after what is probably not meant in it. Throws InputError.
Checked check_camera(const std::filesystem::path& file, std::span<const std::string> overrides,
                     bool json = false);

}  // namespace hilcam
