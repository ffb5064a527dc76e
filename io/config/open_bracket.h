#pragma once
// Finds the bracket of a YAML text that is never closed: the parser says where it gave up, which is further down.

#include <string>
#include <string_view>

namespace hilcam {

// Returns "the [ of line 16 is not closed", or for a bracket that closes none "the ] of line 16 closes none"; empty: all
// are in pairs.
std::string unpaired_bracket(std::string_view text);

}  // namespace hilcam
