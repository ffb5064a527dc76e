#include "io/maps/map_files.h"

#include <algorithm>
#include <string_view>

#include "io/maps/label_statements.h"
#include "io/system/input_file.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

namespace fs = std::filesystem;

// A petabyte; no map is larger.
constexpr std::uintmax_t kMaxMapBytes = std::uintmax_t{1} << 50;
// Labels are shorter, and have their mark near the beginning.
constexpr std::size_t kLabel_bytes = std::size_t{1} << 20, kMark_bytes = std::size_t{1} << 16;
// XML begins with its first mark, after a byte-order mark and blanks at most.
constexpr std::size_t kMax_before_xml = 64;

// Adds every possible file name: the contents of quotation marks, and each word.
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

// Opens what a map's reader would open, and so reports what is wrong with it.
void require_regular(const fs::path& file) {
    open_input_file(file, {kMaxMapBytes, "a regular file, as a part of a map"});
}

bool is_label(const std::string& text) {
    const std::string_view begin = std::string_view(text).substr(0, kMark_bytes);
    return begin.find("PDS_VERSION_ID") != std::string_view::npos ||
           begin.find("ODL_VERSION_ID") != std::string_view::npos ||
           begin.find("IsisCube") != std::string_view::npos;
}

// PDS4's labels are XML in a file of their own.
bool is_pds4_label(const std::string& text) {
    const std::string_view begin = std::string_view(text).substr(0, kMark_bytes);
    return begin.find("<Product_") != std::string_view::npos && begin.find('<') < kMax_before_xml;
}

// Returns a label's text up to its end as readers determine it; empty when the file has no label.
std::string label_of(const fs::path& file, const std::string& name) {
    const InputFile in = open_input_file(file, {kMaxMapBytes, "a map"});
    std::string text(std::min<std::uintmax_t>(in.bytes, kLabel_bytes), '\0');
    read_input_piece(in, file, 0, text.data(), text.size());
    if (is_pds4_label(text)) {
        if (in.bytes > kLabel_bytes)
            throw InputError(name + ": its label is longer than " + std::to_string(kLabel_bytes) +
                             " bytes; accepted: a shorter one");
        return text;
    }
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
    // Readers take the rest of a block with the label, and continue there when that line was inside a
    // comment.
    constexpr std::size_t kBlock_bytes = 520;
    text.resize(std::min({text.size(), end + kBlock_bytes, zero}));
    return text;
}

}  // namespace

namespace {

// Refuses a name that leads out of the map's folder.
void require_plain_name(std::string_view value, const std::string& name) {
    if (value.find_first_of("/\\") == std::string_view::npos) return;
    const std::size_t begin = std::min(value.find_first_not_of(" \t\r\n"), value.size());
    throw InputError(name + ": its label points at " + in_quotes(value.substr(begin)) +
                     "; accepted: the name of a file beside it, without folders");
}

// A PDS4 label names files only in its elements file_name. References (&...;), which could hide other names,
// are refused.
std::vector<std::string> pds4_pointers(const std::string& text, const std::string& name) {
    std::vector<std::string> out;
    if (text.find("<!DOCTYPE") != std::string::npos || text.find("<!ENTITY") != std::string::npos)
        throw InputError(name + ": its label has definitions of its own (DOCTYPE); accepted: without");
    constexpr std::string_view kElement = "file_name";
    for (std::size_t at = text.find(kElement); at != std::string::npos; at = text.find(kElement, at + 1)) {
        const std::size_t begin = text.find('>', at);
        const std::size_t end = begin == std::string::npos ? begin : text.find('<', begin);
        if (end == std::string::npos || text[begin - 1] == '/') continue;
        const std::string_view value = std::string_view(text).substr(begin + 1, end - begin - 1);
        if (value.find('&') != std::string_view::npos)
            throw InputError(name + ": its label points at " + in_quotes(value) +
                             "; accepted: a name without references");
        require_plain_name(value, name);
        const std::size_t first = value.find_first_not_of(" \t\r\n");
        if (first == std::string_view::npos) continue;
        out.emplace_back(value.substr(first, value.find_last_not_of(" \t\r\n") + 1 - first));
    }
    return out;
}

}  // namespace

std::vector<std::string> label_pointers(const std::string& text, const std::string& name) {
    if (is_pds4_label(text)) return pds4_pointers(text, name);
    std::vector<std::string> out;
    visit_label_statements(without_label_comments(text), [&](std::string_view key, std::string_view value) {
        const std::string word = small_letters(key);
        if (word == "format" && small_letters(value).find("geotiff") != std::string::npos)
            throw InputError(name +
                             ": its label has the values in a GeoTIFF; accepted: that file by its own name");
        if ((word == "object" || word == "group") &&
            small_letters(value).find("compressed_file") != std::string::npos)
            throw InputError(name + ": its label has compressed values; accepted: such as they are");
        if (!word.starts_with('^')) return;
        require_plain_name(value, name);
        add_names(value, out);
    });
    return out;
}

MapFiles find_map_files(const fs::path& file, const std::string& name) {
    MapFiles out{fs::absolute(file).lexically_normal(), {}};
    out.label = label_of(out.file, name);
    const std::vector<std::string> pointers = label_pointers(out.label, name);
    const std::string stem = small_letters(out.file.stem().string());
    std::error_code error;
    for (fs::directory_iterator at(out.file.parent_path(), error), end; !error && at != end;
         at.increment(error)) {
        const std::string own = at->path().filename().string();
        const bool is_pointed_at = std::any_of(
            pointers.begin(), pointers.end(),
            [&](const std::string& pointer) { return small_letters(pointer) == small_letters(own); });
        if (!is_pointed_at && !small_letters(own).starts_with(stem)) continue;
        std::error_code absent;
        const fs::file_status status = fs::status(at->path(), absent);
        if (!fs::exists(status) || fs::is_directory(status)) continue;
        if (!fs::is_regular_file(status)) require_regular(at->path());
        if (is_pointed_at) out.pointed_at.push_back(own);
        if (small_letters(own).starts_with(stem)) out.beside.push_back(own);
    }
    return out;
}

}  // namespace hilcam
