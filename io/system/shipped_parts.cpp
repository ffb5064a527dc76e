#include "io/system/shipped_parts.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>

#include "io/system/program_files.h"

namespace hilcam {
namespace {

namespace fs = std::filesystem;

constexpr std::array kShippedKinds = {
    ShippedKind{"scenarios", "scenarios", "hilcam run NAME"},
    ShippedKind{"cameras", "cameras", "camera: NAME"},
    ShippedKind{"qualities", "quality", "quality: NAME"},
    ShippedKind{"materials", "materials", "materials: NAME, or material: NAME of a surface"},
    ShippedKind{"filters", "filters", "camera.color_filter: NAME"},
    ShippedKind{"meshes", "meshes", "objects.0.mesh: NAME"},
    ShippedKind{"maps", "maps", "earth_surface.map: NAME"},
    ShippedKind{"stars", "stars", "stars.catalogue: NAME"},
};

struct KeyOfKind {
    std::string_view key;  // the last words of a key, without numbers of elements
    std::string_view words;
};
constexpr std::array kKeysOfKinds = {
    KeyOfKind{"camera", "cameras"},
    KeyOfKind{"quality", "qualities"},
    KeyOfKind{"loop.levels", "qualities"},
    KeyOfKind{"materials", "materials"},
    KeyOfKind{"material", "materials"},
    KeyOfKind{"color_filter", "filters"},
    KeyOfKind{"color_filter.filters", "filters"},
    KeyOfKind{"mesh", "meshes"},
    KeyOfKind{"albedo_map", "maps"},
    KeyOfKind{"height_map", "maps"},
    KeyOfKind{"earth_surface.map", "maps"},
    KeyOfKind{"cloud_map", "maps"},
    KeyOfKind{"heights.file", "maps"},
    KeyOfKind{"stars.catalogue", "stars"},
};

std::string lower_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

// The files of a kind, by name.
std::vector<fs::path> files_of(const ShippedKind& kind) {
    std::vector<fs::path> out;
    const fs::path folder = data_folder();
    if (folder.empty()) return out;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder / kind.folder, error))
        if (entry.is_regular_file(error)) out.push_back(entry.path());
    std::sort(out.begin(), out.end());
    return out;
}

std::string beginning_of(const fs::path& file) {
    std::string text(4096, '\0');
    std::ifstream in(file, std::ios::binary);
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(in.gcount()));
    return text;
}

// Returns the words of a comment line; empty for other lines, empty comments and indented ones, which are
// commands.
std::string_view comment_words(std::string_view line) {
    for (const std::string_view mark : {"# ", "comment "})
        if (line.starts_with(mark) && line.size() > mark.size() && line[mark.size()] != ' ')
            return line.substr(mark.size());
    return {};
}

// Ends the text after its first sentence: at a full stop before a capital, or at its end.
std::string first_sentence(std::string text) {
    for (std::size_t at = text.find(". "); at != std::string::npos; at = text.find(". ", at + 1))
        if (at + 2 < text.size() && std::isupper(static_cast<unsigned char>(text[at + 2]))) {
            text.resize(at);
            break;
        }
    if (text.ends_with('.')) text.pop_back();
    return text;
}

// A CONFIG on the command line names one of these.
const std::array kConfigKinds = {&kShippedKinds[0], &kShippedKinds[1]};

}  // namespace

std::span<const ShippedKind> shipped_kinds() { return kShippedKinds; }

const ShippedKind* shipped_kind(std::string_view words) {
    for (const ShippedKind& kind : kShippedKinds)
        if (kind.words == words) return &kind;
    return nullptr;
}

const ShippedKind* kind_of_key(std::string_view key) {
    const std::size_t dot = key.rfind('.');
    const std::string_view last = dot == std::string_view::npos ? key : key.substr(dot + 1);
    if (dot != std::string_view::npos && last.find_first_not_of("0123456789") == std::string_view::npos)
        key = key.substr(0, dot);
    for (const KeyOfKind& entry : kKeysOfKinds)
        if (key == entry.key || (key.ends_with(entry.key) && key[key.size() - entry.key.size() - 1] == '.'))
            return shipped_kind(entry.words);
    return nullptr;
}

fs::path shipped_part(const ShippedKind& kind, const fs::path& name) {
    if (name.empty() || name.has_parent_path() || name.has_extension()) return {};
    const std::string wanted = lower_case(name.string());
    for (const fs::path& file : files_of(kind))
        if (lower_case(file.stem().string()) == wanted) return file;
    return {};
}

std::vector<ShippedPart> shipped_parts(const ShippedKind& kind) {
    std::vector<ShippedPart> out;
    for (const fs::path& file : files_of(kind))
        out.push_back({file.stem().string(), first_sentence_of(beginning_of(file)), file});
    return out;
}

std::vector<std::string> shipped_names(const ShippedKind& kind) {
    std::vector<std::string> out;
    for (const fs::path& file : files_of(kind)) out.push_back(file.stem().string());
    return out;
}

std::string first_sentence_of(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        // The header of a PLY comes before its comments.
        if (out.empty() && (line == "ply" || line.starts_with("format "))) continue;
        if (line.starts_with("# yaml-language-server")) continue;
        const std::string_view words = comment_words(line);
        if (words.empty()) break;
        out += (out.empty() ? "" : " ") + std::string(words);
    }
    return first_sentence(std::move(out));
}

fs::path named_config(const fs::path& name) {
    std::error_code error;
    if (name.empty() || fs::exists(name, error)) return name;
    if (const fs::path file = shipped_file(name); !file.empty()) return file;
    for (const ShippedKind* const kind : kConfigKinds)
        if (fs::path file = shipped_part(*kind, name); !file.empty()) return file;
    return name;
}

std::vector<std::string> config_names() {
    std::vector<std::string> out;
    for (const ShippedKind* const kind : kConfigKinds)
        for (std::string& name : shipped_names(*kind)) out.push_back(std::move(name));
    return out;
}

}  // namespace hilcam
