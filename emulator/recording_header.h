#pragma once
// What a recording begins with: who made it, of what.

#include "emulator/app_config.h"
#include "emulator/clock.h"
#include "emulator/recording.h"

namespace hilcam {

// Of this program on this machine. Reads the program's file and all that the scenario names.
RecordingHeader recording_header(const ScenarioConfig& scenario, const SimulatedClock& clock);

// What makes a recording that may not come out the same when it is replayed; a line each.
std::vector<std::string> recording_warnings(const ScenarioConfig& scenario);

}  // namespace hilcam
