#pragma once
// The beginning of a recording: who made it, of what.

#include "emulator/recording/recording.h"
#include "emulator/scenario/app_config.h"

namespace hilcam {

// Makes the header of this program on this machine, except when the run began. Reads the program's file and
// all that the scenario names: as long as that takes.
RecordingHeader recording_header(const ScenarioConfig& scenario);

// Says what makes a recording that may not come out the same when it is replayed; a line each.
std::vector<std::string> recording_warnings(const ScenarioConfig& scenario);

}  // namespace hilcam
