#include "io/maps/map_files.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>

#include "io/system/input_file.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

namespace fs = std::filesystem;

// A petabyte is no map.
constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 50;
// Labels are shorter, and say at their begin that they are some.
constexpr std::size_t kLabel_bytes = std::size_t{1} << 20, kMark_bytes = std::size_t{1} << 16;

// Names are looked for in any case, as readers of labels do.
std::string lower(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return std::tolower(c); });
    return out;
}

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) || c == '\0'; }

// Returns where the text goes on after blanks and comments.
std::size_t after_blanks(std::string_view text, std::size_t at) {
    for (;;) {
        while (at < text.size() && is_blank(text[at])) ++at;
        if (text.substr(at, 2) != "/*") return at;
        const std::size_t end = text.find("*/", at + 2);
        if (end == std::string_view::npos) return text.size();
        at = end + 2;
    }
}

// Returns the value at a place of a label: a text between quotes, a list between brackets, or a word.
std::string_view value_at(std::string_view text, std::size_t at) {
    at = after_blanks(text, at);
    if (at >= text.size()) return {};
    const char first = text[at];
    const char last = first == '"' || first == '\'' ? first : first == '(' ? ')' : first == '{' ? '}' : '\0';
    std::size_t end = at + 1;
    while (end < text.size() && (last == '\0' ? !is_blank(text[end]) : text[end] != last)) ++end;
    return text.substr(at, end - at);
}

// Calls take(key, value) for each "KEY = value" of a label.
template <class Take>
void visit_statements(std::string_view text, const Take& take) {
    for (std::size_t at = text.find('='); at != std::string_view::npos; at = text.find('=', at + 1)) {
        std::size_t end = at;
        while (end > 0 && is_blank(text[end - 1])) --end;
        std::size_t begin = end;
        while (begin > 0 && (is_word(text[begin - 1]) || text[begin - 1] == '^')) --begin;
        take(text.substr(begin, end - begin), value_at(text, at + 1));
    }
}

// Returns the name in a pointer's value, which may also have a place in the file, or be nothing but that.
std::optional<std::string> pointed_name(std::string_view value) {
    const auto is_outside = [](char c) {
        return is_blank(c) || std::string_view("\"'(){},<>").find(c) != std::string_view::npos;
    };
    std::size_t begin = 0, end = 0;
    while (begin < value.size() && is_outside(value[begin])) ++begin;
    const std::size_t quote = value.find_first_of("\"'");
    if (quote != std::string_view::npos) {
        begin = quote + 1;
        end = std::min(value.find_first_of("\"'", begin), value.size());
    } else {
        end = begin;
        while (end < value.size() && !is_outside(value[end])) ++end;
    }
    const std::string name(value.substr(begin, end - begin));
    const bool is_number =
        std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c); });
    return is_number ? std::nullopt : std::optional(name);
}

// Opens what a map's reader would open, and so says what is wrong with it.
void require_regular(const fs::path& file) {
    open_input_file(file, {kMostBytes, "a regular file, as a part of a map"});
}

bool is_label(const std::string& text) {
    const std::string_view begin = std::string_view(text).substr(0, kMark_bytes);
    return begin.find("PDS_VERSION_ID") != std::string_view::npos ||
           begin.find("ODL_VERSION_ID") != std::string_view::npos ||
           begin.find("IsisCube") != std::string_view::npos;
}

std::string first_bytes(const fs::path& file) {
    const InputFile in = open_input_file(file, {kMostBytes, "a map"});
    std::string text(std::min<std::uintmax_t>(in.bytes, kLabel_bytes), '\0');
    read_input_piece(in, file, 0, text.data(), text.size());
    return text;
}

}  // namespace

std::vector<std::string> label_pointers(const std::string& text, const std::string& name) {
    std::vector<std::string> out;
    visit_statements(text, [&](std::string_view key, std::string_view value) {
        const std::string word = lower(key);
        if (word == "format" && lower(value).find("geotiff") != std::string::npos)
            throw InputError(name +
                             ": its label has the values in a GeoTIFF; accepted: that file by its own name");
        if ((word == "object" || word == "group") && lower(value).find("compressed_file") == 0)
            throw InputError(name + ": its label has compressed values; accepted: such as they are");
        if (!word.starts_with('^')) return;
        const std::optional<std::string> file = pointed_name(value);
        if (!file) return;
        // A pointer may not lead elsewhere in any part of its value.
        if (value.find('/') != std::string_view::npos || value.find('\\') != std::string_view::npos ||
            *file == "." || *file == "..")
            throw InputError(name + ": its label points at " + in_quotes(value) +
                             "; accepted: the name of a file beside it, without folders");
        out.push_back(*file);
    });
    return out;
}

MapFiles find_map_files(const fs::path& file, const std::string& name) {
    MapFiles out{fs::absolute(file).lexically_normal(), {}};
    const std::string text = first_bytes(out.file);
    const std::vector<std::string> pointers =
        is_label(text) ? label_pointers(text, name) : std::vector<std::string>();
    const std::string stem = lower(out.file.stem().string());
    std::error_code error;
    for (fs::directory_iterator at(out.file.parent_path(), error), end; !error && at != end;
         at.increment(error)) {
        const std::string own = at->path().filename().string();
        const bool is_pointed_at =
            std::any_of(pointers.begin(), pointers.end(),
                        [&](const std::string& pointer) { return lower(pointer) == lower(own); });
        if (!is_pointed_at && !lower(own).starts_with(stem)) continue;
        std::error_code absent;
        const fs::file_status status = fs::status(at->path(), absent);
        if (!fs::exists(status) || fs::is_directory(status)) continue;
        if (!fs::is_regular_file(status)) require_regular(at->path());
        if (is_pointed_at) out.pointed_at.push_back(own);
        if (lower(own).starts_with(stem)) out.beside.push_back(own);
    }
    return out;
}

}  // namespace hilcam
