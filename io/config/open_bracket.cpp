#include "io/config/open_bracket.h"

#include <algorithm>
#include <vector>

namespace hilcam {
namespace {

struct Bracket {
    char kind;
    std::size_t line;
};

std::string named(char bracket, std::size_t line) {
    return std::string("the ") + bracket + " of line " + std::to_string(line);
}

// Skips a quoted text; at: of the first quote. Returns the position of the last quote.
std::size_t end_of_quotes(std::string_view text, std::size_t at, std::size_t& line) {
    const char quote = text[at];
    for (++at; at < text.size(); ++at) {
        const bool doubled = quote == '\'' && text.substr(at, 2) == "''";
        if (doubled || (quote == '"' && text[at] == '\\'))
            ++at;
        else if (text[at] == quote)
            break;
        if (at < text.size() && text[at] == '\n') ++line;
    }
    return at;
}

// A quote opens a text, and a # a comment, only where a value may begin: "don't" and "a#b" are words.
bool may_begin(std::string_view text, std::size_t at) {
    return at == 0 || std::string_view(" \n\t[{,:").find(text[at - 1]) != std::string_view::npos;
}

}  // namespace

std::string unpaired_bracket(std::string_view text) {
    std::vector<Bracket> open;
    std::size_t line = 1;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '\n')
            ++line;
        else if (c == '#' && may_begin(text, i))
            i = std::min(text.find('\n', i), text.size()) - 1;
        else if ((c == '"' || c == '\'') && may_begin(text, i))
            i = end_of_quotes(text, i, line);
        else if ((c == '[' || c == '{') && (may_begin(text, i) || !open.empty()))
            open.push_back({c, line});
        else if (c == ']' || c == '}') {
            if (open.empty()) return named(c, line) + " closes none";
            if ((open.back().kind == '[') != (c == ']')) break;
            open.pop_back();
        }
    }
    return open.empty() ? "" : named(open.back().kind, open.back().line) + " is not closed";
}

}  // namespace hilcam
