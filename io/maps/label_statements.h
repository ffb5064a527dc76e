#pragma once
// Splits the text of a PDS3 or ISIS label into statements.

#include <cctype>
#include <string>
#include <string_view>

namespace hilcam {

// Removes comments without quotation marks. A comment with one may be part of a quoted text, which may have
// slashes.
std::string without_label_comments(std::string_view text);

// Calls take(key, value) for each "KEY = value" of a label. A value extends to the next equals sign and
// includes the next statement's key, so that no other reader of labels, whatever it makes of brackets and
// quotes, finds more in it.
template <class Take>
void visit_label_statements(std::string_view text, const Take& take) {
    const auto is_blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
    const auto is_of_key = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '^';
    };
    for (std::size_t at = text.find('='); at != std::string_view::npos; at = text.find('=', at + 1)) {
        std::size_t end = at;
        while (end > 0 && is_blank(text[end - 1])) --end;
        std::size_t begin = end;
        while (begin > 0 && is_of_key(text[begin - 1])) --begin;
        take(text.substr(begin, end - begin), text.substr(at + 1, text.find('=', at + 1) - at - 1));
    }
}

// Returns the text in lower case, in which words of labels and file names are compared.
std::string small_letters(std::string_view text);

}  // namespace hilcam
