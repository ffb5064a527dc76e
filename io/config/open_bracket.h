#pragma once
// Finds a bracket of a YAML text that is never closed. The parser reports only where it gave up, further
// down.

#include <string>
#include <string_view>

namespace hilcam {

// Returns "the [ of line 16 is not closed", or "the ] of line 16 closes none"; empty when all brackets are
// paired.
std::string unpaired_bracket(std::string_view text);

}  // namespace hilcam
