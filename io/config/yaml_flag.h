#pragma once
// Words that YAML 1.1 takes for true and false. Scripts that read a file by it and write it again have `true` where it had `on`, also
// in the place of a key or of a choice.

#include <optional>
#include <string>

#include "render/vocabulary/config_field.h"

namespace YAML {
class Node;
}

namespace hilcam {

// Returns what a word means by YAML 1.1 (the type "bool"; without y and n, which PyYAML leaves words); nothing for other words.
std::optional<bool> flag_of(const std::string& word);

// Returns the key as a section has it: `on` where a script wrote true.
std::string known_key(const std::string& key, const Fields& known);
// Returns the value of a section's key; an undefined node where there is none.
YAML::Node value_of_key(const YAML::Node& map, const std::string& key, const Fields& known);

}  // namespace hilcam
