#pragma once
// Makes text from outside (a file, the wire, the command line) safe to print: one line that shows what was
// found and cannot control a terminal.
//
// A blank replaces each control character (C0, DELETE, C1, so also the start of a terminal's escape
// sequence), each character that changes the direction of text, and each byte that is not valid UTF-8. Any
// thread.

#include <string>
#include <string_view>

namespace hilcam {

// Returns the whole text.
std::string harmless(std::string_view text);
// Returns at most 60 bytes, cut between characters; "..." at the end marks a cut.
std::string shortened(std::string_view text);
// Returns shortened(text) in single quotes.
std::string in_quotes(std::string_view text);

}  // namespace hilcam
