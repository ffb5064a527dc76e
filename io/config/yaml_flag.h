#pragma once
// Words that YAML 1.1 reads as true and false. A script that reads a file by YAML 1.1 and writes it back puts
// `true` for `on`, even as a key or a choice.

#include <optional>
#include <string>

#include "render/vocabulary/config_field.h"

namespace YAML {
class Node;
}

namespace hilcam {

// Returns the meaning of a word in YAML 1.1 (the type "bool", without y and n, which PyYAML leaves as words);
// nothing for other words.
std::optional<bool> flag_of(const std::string& word);

// Returns the key as a section has it: `on` where a script wrote true.
std::string known_key(const std::string& key, const Fields& known);
// Returns the value of a section's key; an undefined node when there is none.
YAML::Node value_of_key(const YAML::Node& map, const std::string& key, const Fields& known);

}  // namespace hilcam
