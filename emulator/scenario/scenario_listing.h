#pragma once
// A scenario as lines "key = value": everything that its frames depend on, so that two scenarios can be
// compared.
//
// The listing has every key of the configuration, given or not, in the manual's order; for a file that a key
// names, its name, length and CRC-32. It leaves out keys that are defined not to affect frames
// (Field::changes_frames: outputs, commands, threads, ...), and events and faults, because a recording
// contains what they did. Files that those files name in turn, such as a glTF file's textures, are not
// examined.

#include <string>

#include "emulator/scenario/app_config.h"

namespace hilcam {

std::string scenario_listing(ScenarioConfig scenario);
// Returns the listing of one section.
std::string section_listing(const SectionField& section);

// Returns the value of a key in a listing; empty when the listing does not have the key.
std::string listed_value(const std::string& listing, const std::string& key);

// Describes the difference between two listings for people: "camera.exposure_ms: 2 there, 5 here (and 3
// more)". Empty: they are equal.
std::string listing_difference(const std::string& there, const std::string& here);

}  // namespace hilcam
