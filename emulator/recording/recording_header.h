#pragma once
// Makes the header of a recording: the program and machine that made it, and the scenario.

#include "emulator/recording/recording.h"
#include "emulator/scenario/app_config.h"

namespace hilcam {

// Returns the header for this program and machine, without the start times. Reads the program file and all
// files that the scenario names, which takes its time.
RecordingHeader recording_header(const ScenarioConfig& scenario);

// Returns reasons why a replay may differ from the run, one line each.
std::vector<std::string> recording_warnings(const ScenarioConfig& scenario);

}  // namespace hilcam
