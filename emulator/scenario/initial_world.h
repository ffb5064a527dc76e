#pragma once
// The world at a scenario's start, before any command.

#include <vector>

#include "emulator/scenario/app_config.h"
#include "emulator/world/world_state.h"

namespace hilcam {

// Returns the initial motions of camera and objects.
std::vector<Motion> initial_motions(const ScenarioConfig& scenario, TimeTai time);
// Returns the joints of all objects, object by object.
std::vector<Joint> joints_of(const ScenarioConfig& scenario);
// Returns the world at an instant by the scenario alone, without commands.
WorldSnapshot snapshot_at(const ScenarioConfig& scenario, TimeTai start, TimeTai time);

}  // namespace hilcam
