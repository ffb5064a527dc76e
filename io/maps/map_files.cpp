#include "io/maps/map_files.h"

#include <algorithm>
#include <cctype>
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

bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
bool is_of_key(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '^'; }

// Takes out comments that no quotation can begin or end in, which may have slashes.
std::string without_comments(std::string_view text) {
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

// Calls take(key, value) for each "KEY = value" of a label. A value goes on to the next statement's key and includes that, so that no
// reader of labels, whatever it makes of brackets and quotes, finds more in it.
template <class Take>
void visit_statements(std::string_view text, const Take& take) {
    for (std::size_t at = text.find('='); at != std::string_view::npos; at = text.find('=', at + 1)) {
        std::size_t end = at;
        while (end > 0 && is_blank(text[end - 1])) --end;
        std::size_t begin = end;
        while (begin > 0 && is_of_key(text[begin - 1])) --begin;
        take(text.substr(begin, end - begin), text.substr(at + 1, text.find('=', at + 1) - at - 1));
    }
}

// Adds what may be the name of a file: what stands between quotes, and each word.
void add_names(std::string_view value, std::vector<std::string>& names) {
    const auto add_pieces = [&](std::string_view separators) {
        for (std::size_t at = 0; at < value.size();) {
            const std::size_t end = std::min(value.find_first_of(separators, at), value.size());
            if (end > at) names.emplace_back(value.substr(at, end - at));
            at = end + 1;
        }
    };
    add_pieces("\"'");
    add_pieces("\"'(){},<> \t\r\n\f\v");
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

// Returns a label's text up to its end, as readers look for it; nothing of a file that is no label.
std::string label_of(const fs::path& file, const std::string& name) {
    const InputFile in = open_input_file(file, {kMostBytes, "a map"});
    std::string text(std::min<std::uintmax_t>(in.bytes, kLabel_bytes), '\0');
    read_input_piece(in, file, 0, text.data(), text.size());
    if (!is_label(text)) return {};
    std::size_t end = text.size();
    for (const char* const mark : {"\nEND\n", "\nEND\r\n", "\nEnd\n", "\nEnd\r\n"})
        end = std::min(end, text.find(mark));
    if (end == text.size() && in.bytes > kLabel_bytes)
        throw InputError(name + ": its label has no line END within " + std::to_string(kLabel_bytes) +
                         " bytes; accepted: a label that has");
    const std::size_t zero = text.find('\0');
    if (zero < end)
        throw InputError(name + ": its label has bytes that are no text; accepted: text up to the line END");
    // Readers take the rest of a block with it, and go on in there where that line was a comment's.
    constexpr std::size_t kBlock_bytes = 520;
    text.resize(std::min({text.size(), end + kBlock_bytes, zero}));
    return text;
}

}  // namespace

std::vector<std::string> label_pointers(const std::string& text, const std::string& name) {
    std::vector<std::string> out;
    visit_statements(without_comments(text), [&](std::string_view key, std::string_view value) {
        const std::string word = lower(key);
        if (word == "format" && lower(value).find("geotiff") != std::string::npos)
            throw InputError(name +
                             ": its label has the values in a GeoTIFF; accepted: that file by its own name");
        if ((word == "object" || word == "group") &&
            lower(value).find("compressed_file") != std::string::npos)
            throw InputError(name + ": its label has compressed values; accepted: such as they are");
        if (!word.starts_with('^')) return;
        if (value.find_first_of("/\\") != std::string_view::npos)
            throw InputError(name + ": its label points at " +
                             in_quotes(value.substr(value.find_first_not_of(" \t\r\n"))) +
                             "; accepted: the name of a file beside it, without folders");
        add_names(value, out);
    });
    return out;
}

MapFiles find_map_files(const fs::path& file, const std::string& name) {
    MapFiles out{fs::absolute(file).lexically_normal(), {}};
    const std::vector<std::string> pointers = label_pointers(label_of(out.file, name), name);
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
