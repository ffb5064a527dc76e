#pragma once
// The world as a scenario begins it, before anybody has commanded anything.

#include <vector>

#include "emulator/scenario/app_config.h"
#include "emulator/world/world_state.h"

namespace hilcam {

// The motions of camera and objects as the scenario begins them.
std::vector<Motion> initial_motions(const ScenarioConfig& scenario, TimeTai time);
// All objects' turning parts, object by object.
std::vector<Joint> joints_of(const ScenarioConfig& scenario);
// Returns what the scenario says of an instant, if no command comes.
WorldSnapshot snapshot_at(const ScenarioConfig& scenario, TimeTai start, TimeTai time);

}  // namespace hilcam
