#pragma once
// What configuration files accept, in words.

#include <string>

#include "render/config_field.h"

namespace hilcam {

// "0 to 5", "1 or more", "5 or less", "any number".
std::string accepted(const Range& range);

// A Markdown table of the keys: key, accepted, default, meaning. Nested sections follow as rows
// "section.key".
std::string config_manual(const SectionField& root);

}  // namespace hilcam
