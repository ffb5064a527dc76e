#pragma once
// The mark with which some editors begin a text (U+FEFF, "byte-order mark"), and texts in UTF-16.

#include <string>
#include <string_view>

namespace hilcam {

// Returns the text after the mark that UTF-8 may begin with (Unicode 15.0, 23.8). Throws InputError, one line
// that begins with `name`, for UTF-16 and UTF-32, which it recognises by their mark or by zeros between the
// letters. Any thread.
std::string_view without_mark(std::string_view text, const std::string& name);

// Returns the text in UTF-8 without its mark. UTF-16 is recognised by its mark or by zeros beside its first
// letters; an invalid code unit becomes U+FFFD (Unicode 15.0, 3.9 and 3.10). Any thread.
std::string in_utf8(std::string_view text);

}  // namespace hilcam
