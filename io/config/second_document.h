#pragma once
// Finds where a YAML text begins a second document. A file of settings holds one: of several, which one was meant is
// not known.

#include <cstddef>
#include <optional>
#include <string_view>

namespace hilcam {

// Returns the number, from 1, of the line "---" with which the second document begins that has content; nothing where
// there is one document at most. No value can hold such a line (YAML 1.2.2, 9.1.2, c-forbidden).
std::optional<std::size_t> line_of_second_document(std::string_view text);

}  // namespace hilcam
