#include "io/maps/label_statements.h"

#include <algorithm>

namespace hilcam {

std::string without_label_comments(std::string_view text) {
    std::string out(text);
    for (std::size_t at = out.find("/*"); at != std::string::npos; at = out.find("/*", at)) {
        const std::size_t end = out.find("*/", at + 2);
        if (end == std::string::npos || out.substr(at, end - at).find_first_of("\"'") != std::string::npos)
            ++at;
        else
            out.replace(at, end + 2 - at, " ");
    }
    return out;
}

std::string small_letters(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return std::tolower(c); });
    return out;
}

}  // namespace hilcam
