#pragma once
// What a recording begins with: who made it, of what.

#include "emulator/app_config.h"
#include "emulator/recording.h"

namespace hilcam {

// Of this program on this machine. monotonic_start_ns: when simulated time began. Reads the program's file
// and all that the scenario names.
RecordingHeader recording_header(const ScenarioConfig& scenario, std::int64_t monotonic_start_ns);

// What makes a recording that may not come out the same when it is replayed; a line each.
std::vector<std::string> recording_warnings(const ScenarioConfig& scenario);

}  // namespace hilcam
