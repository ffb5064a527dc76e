#pragma once
// Warns of what a scenario says that has no effect, or hides everything: it may be meant, so it is no error,
// but whoever runs it is told.

#include <string>
#include <vector>

#include "emulator/scenario/app_config.h"

namespace hilcam {

struct LoadedObject;

// A line each. What a run will not do: lockstep in which nobody can ask for a frame, faults that no output or
// port can show, a camera whose frames nobody gets, keys that do nothing beside the others.
std::vector<std::string> idle_warnings(const ScenarioConfig& scenario);
// Says what a kind of fault needs to be seen and the outputs of some cameras and the bench's commands lack;
// empty: it is there.
std::string lacking_output(const std::vector<const OutputsConfig*>& outputs, const CommandsConfig& commands,
                           FaultKind kind);
// Cameras that begin inside a body. Throws InputError where the scenario's motions cannot be had.
std::vector<std::string> place_warnings(const ScenarioConfig& scenario);
// Says which rules of objects have no effect, and the surfaces that there are; once for those that are alike in that.
std::vector<std::string> warnings_of(const std::vector<LoadedObject>& objects);

}  // namespace hilcam
