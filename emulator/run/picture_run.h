#pragma once
// The notes on the run in the pictures of one of the scenario's cameras (io/images/picture_notes.h).

#include "emulator/scenario/app_config.h"
#include "io/images/picture_notes.h"

namespace hilcam {

// The scenario as the camera of that number has it, from 1 (scenario_of_camera()).
PictureRun picture_run_of(const ScenarioConfig& scenario, std::size_t number);

}  // namespace hilcam
