#include "io/config/second_document.h"

#include <algorithm>

namespace hilcam {
namespace {

constexpr std::string_view kBlanks = " \t\r";

// True for "---" and "...", alone or with something after a blank.
bool is_marker(std::string_view line, std::string_view marker) {
    return line.starts_with(marker) &&
           (line.size() == marker.size() || kBlanks.find(line[marker.size()]) != std::string_view::npos);
}

// True when the line has content of a document: it is neither a comment nor a directive.
bool has_content(std::string_view line) {
    const std::size_t first = line.find_first_not_of(kBlanks);
    return first != std::string_view::npos && line[first] != '#' && line.front() != '%';
}

}  // namespace

std::optional<std::size_t> line_of_second_document(std::string_view text) {
    bool first_has_content = false;
    std::optional<std::size_t> begin;  // line where the text after the first document begins
    for (std::size_t number = 1; !text.empty(); ++number) {
        std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(text.size(), line.size() + 1));
        const bool begins = is_marker(line, "---");
        if (begins || is_marker(line, "...")) {
            if (first_has_content && !begin) begin = number;
            line.remove_prefix(begins ? 3 : line.size());
        }
        if (!has_content(line.empty() ? " " : line)) continue;
        if (begin) return begin;
        first_has_content = true;
    }
    return {};
}

}  // namespace hilcam
