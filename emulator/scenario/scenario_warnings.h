#pragma once
// Warns of what a scenario says that has no effect, or hides everything: it may be meant, so it is no error,
// but whoever runs it is told.

#include <string>
#include <vector>

#include "emulator/scenario/app_config.h"

namespace hilcam {

struct LoadedObject;

// A line each, with the place of the key (KeyPlaces). What a run will not do: lockstep in which nobody can ask for a
// frame, events that will be refused, faults that no output or port can show, one camera of several whose frames nobody
// gets.
std::vector<std::string> idle_run_warnings(const ScenarioConfig& scenario);
// A run that gives its frames to nobody at all; scenarios for `render` are such.
std::vector<std::string> no_output_warnings(const ScenarioConfig& scenario);
// Keys that do nothing beside the others, objects of one name.
std::vector<std::string> idle_warnings(const ScenarioConfig& scenario);
// Heights and orbits so far out that their unit is probably another.
std::vector<std::string> length_warnings(const ScenarioConfig& scenario);
// Says what a kind of fault needs to be seen and the outputs of some cameras and the bench's commands lack;
// empty: it is there.
std::string lacking_output(const std::vector<const OutputsConfig*>& outputs, const CommandsConfig& commands,
                           FaultKind kind);
// Cameras and objects that begin inside a body, and objects on the same place. Throws InputError where the scenario's motions cannot be had.
std::vector<std::string> place_warnings(const ScenarioConfig& scenario);
// Says which rules of objects have no effect, and the surfaces that there are; once for those that are alike in that.
std::vector<std::string> warnings_of(const std::vector<LoadedObject>& objects, const KeyPlaces& places);

}  // namespace hilcam
