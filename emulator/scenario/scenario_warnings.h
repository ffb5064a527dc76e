#pragma once
// Warns of settings that have no effect, or hide everything. They may be intended, so they are not errors.

#include <string>
#include <vector>

#include "emulator/scenario/app_config.h"

namespace hilcam {

struct LoadedObject;

// Each returns one line for each warning, with the place of the key (KeyPlaces). This one warns of what a run
// will not do: lockstep without a source of orders, events that will be refused, faults that no output or
// port can show, one camera of several without any receiver for its frames.
std::vector<std::string> idle_run_warnings(const ScenarioConfig& scenario);
// Warns of a run without any receiver for its frames, as with scenarios made for `render`.
std::vector<std::string> no_output_warnings(const ScenarioConfig& scenario);
// Warns of keys that have no effect beside others, and of objects with the same name.
std::vector<std::string> idle_warnings(const ScenarioConfig& scenario);
// Warns of heights and orbits so large that they are probably given in another unit.
std::vector<std::string> length_warnings(const ScenarioConfig& scenario);
// Says what a kind of fault needs in order to be seen, if these outputs and commands lack it; empty: it can
// be seen.
std::string lacking_output(const std::vector<const OutputsConfig*>& outputs, const CommandsConfig& commands,
                           FaultKind kind);
// Warns of cameras and objects that begin inside a body, and of objects at the same place. Throws InputError
// when the scenario's motions cannot be built.
std::vector<std::string> place_warnings(const ScenarioConfig& scenario);
// Warns of material rules without effect, and lists the existing surfaces; once for objects that are alike.
std::vector<std::string> warnings_of(const std::vector<LoadedObject>& objects, const KeyPlaces& places);

}  // namespace hilcam
