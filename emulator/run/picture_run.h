#pragma once
// Notes about the run in the pictures of one camera (io/images/picture_notes.h).

#include "emulator/scenario/app_config.h"
#include "io/images/picture_notes.h"

namespace hilcam {

// scenario: as the camera with that number has it (scenario_of_camera()); number: from 1.
PictureRun picture_run_of(const ScenarioConfig& scenario, std::size_t number);

}  // namespace hilcam
