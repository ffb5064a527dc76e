#pragma once
// The mark with which some editors begin a text (U+FEFF, "byte-order mark"), and texts of 16-bit letters (UTF-16).

#include <string>
#include <string_view>

namespace hilcam {

// Returns the text behind the mark that UTF-8 may begin with (Unicode 15.0, 23.8). Throws InputError, one line that begins with `name`, for
// UTF-16 and UTF-32, which nothing but the mark or the zeros between its letters tells from UTF-8. Any thread.
std::string_view without_mark(std::string_view text, const std::string& name);

// Returns the text in UTF-8 without its mark; one of UTF-16 is told by its mark or by the zeros beside its first letters, and what is no
// letter in it becomes U+FFFD (Unicode 15.0, 3.9 and 3.10). Any thread.
std::string in_utf8(std::string_view text);

}  // namespace hilcam
