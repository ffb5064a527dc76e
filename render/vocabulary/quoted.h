#pragma once
// Text from outside (a file, the wire, the command line) as a message can show it: one line that says what
// was found and makes no terminal do anything.
//
// A blank takes the place of every control character (C0, DELETE, C1: among them what begins a terminal's
// escape sequences), of the characters that turn the direction of what follows, and of every byte that is no
// UTF-8. Any thread.

#include <string>
#include <string_view>

namespace hilcam {

// Returns all of it.
std::string harmless(std::string_view text);
// Returns at most 60 bytes of it, whole characters; "..." at the end says that there was more.
std::string shortened(std::string_view text);
// Returns that between single quotes.
std::string in_quotes(std::string_view text);

}  // namespace hilcam
