#pragma once
// Finds the start of a second document in a YAML text. A configuration file has one document; with several,
// it would be unclear which one was meant.

#include <cstddef>
#include <optional>
#include <string_view>

namespace hilcam {

// Returns the line number, from 1, of the "---" that begins the second document with content; nothing when
// there is at most one document. No value can contain such a line (YAML 1.2.2, 9.1.2, c-forbidden).
std::optional<std::size_t> line_of_second_document(std::string_view text);

}  // namespace hilcam
