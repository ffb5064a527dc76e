#pragma once
// A scenario as lines "key = value": all that its frames depend on, so that two can be compared.
//
// Every key of the configuration, given or not, in the order of the manual; of a file that a key names, its
// name, length and CRC-32. Not in it: keys whose definition says that frames do not depend on them
// (Field::changes_frames: outputs, commands, threads, ...); events and faults are among those, as a recording
// holds what they did. Files that those files name in turn (a glTF file's textures) are not looked at.

#include <string>

#include "emulator/scenario/app_config.h"

namespace hilcam {

std::string scenario_listing(ScenarioConfig scenario);
// The same of a part of it.
std::string section_listing(const SectionField& section);

// The value of a key in a listing; empty where it has none.
std::string listed_value(const std::string& listing, const std::string& key);

// Says where two listings differ, for people: "camera.exposure_ms: 2 there, 5 here (and 3 more)". Empty:
// nowhere.
std::string listing_difference(const std::string& there, const std::string& here);

}  // namespace hilcam
