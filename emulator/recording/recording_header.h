#pragma once
// What a recording begins with: who made it, of what.

#include "emulator/recording/recording.h"
#include "emulator/scenario/app_config.h"

namespace hilcam {

// Of this program on this machine, but for when the run began. Reads the program's file and all that the
// scenario names: as long as that takes.
RecordingHeader recording_header(const ScenarioConfig& scenario);

// What makes a recording that may not come out the same when it is replayed; a line each.
std::vector<std::string> recording_warnings(const ScenarioConfig& scenario);

}  // namespace hilcam
