#include "io/meshes/named_files.h"

#include <algorithm>
#include <system_error>

#include "io/files/text_lines.h"
#include "io/images/picture_file.h"
#include "io/images/picture_size.h"
#include "io/system/input_file.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

using Path = std::filesystem::path;

char small_letter(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool is_same_word(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](char x, char y) { return small_letter(x) == small_letter(y); });
}

// A pipe counts as well: opening it then reports what it is.
bool is_file_there(const Path& file) {
    std::error_code error;
    return std::filesystem::exists(file, error) && !std::filesystem::is_directory(file, error);
}

// Returns the entry of the folder with this name in any case; of several, the alphabetically first. Empty:
// none.
Path entry_of(const Path& folder, const std::string& name) {
    std::error_code error;
    Path found;
    for (const auto& entry : std::filesystem::directory_iterator(folder.empty() ? "." : folder, error)) {
        const Path own = entry.path().filename();
        if (is_same_word(own.string(), name) && (found.empty() || own < found)) found = own;
    }
    return found.empty() ? Path() : folder / found;
}

// Follows the components of the name from the folder, each in any case if necessary. Empty: there is no such
// file.
Path without_case(Path at, const Path& name) {
    if (name.is_absolute()) at = "/";
    for (const Path& word : name.relative_path()) {
        std::error_code error;
        const Path next = at / word;
        at = std::filesystem::exists(next, error) ? next : entry_of(at, word.string());
        if (at.empty()) return {};
    }
    return is_file_there(at) ? at : Path();
}

struct FoundFile {
    Path file;           // empty: not found
    bool whole = false;  // by its whole name
};

FoundFile sought(const Path& mesh, const FileName& name) {
    std::vector<Path> folders = name.folders;
    folders.push_back(mesh.parent_path());
    std::string slashes = name.name;
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    for (const std::string& way : {name.name, slashes})
        for (const Path& folder : folders)
            if (is_file_there(folder / way)) return {folder / way, true};
    for (const Path& folder : folders)
        if (const Path file = without_case(folder, slashes); !file.empty()) return {file, false};
    const Path last = Path(slashes).filename();
    if (last.empty()) return {};
    return {without_case(mesh.parent_path(), last), false};
}

bool is_inside(const Path& mesh, const Path& file) {
    std::error_code error;
    const Path real = std::filesystem::weakly_canonical(file, error);
    for (const Path& folder : mesh_folders(mesh)) {
        const Path way = real.lexically_relative(folder);
        if (!way.empty() && *way.begin() != "..") return true;
    }
    return false;
}

// True when the name leads out of the mesh's folders, so that the child cannot list the folder.
bool leads_outside(const Path& mesh, const FileName& name) {
    std::string slashes = name.name;
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    const auto outside = [&](const Path& folder) {
        std::error_code error;
        const Path from = (folder / slashes).parent_path();
        return std::filesystem::is_directory(from, error) && !is_inside(mesh, from / "a");
    };
    return outside(mesh.parent_path()) || std::any_of(name.folders.begin(), name.folders.end(), outside);
}

// Textures are recognised by their first bytes; a JPEG may have a preview of itself before its size.
bool opens_as_picture(const Path& file) {
    constexpr std::uintmax_t kOpening_bytes = 1u << 20;
    const InputFile in = open_input_file(file, picture_kind());
    std::string bytes(std::min(in.bytes, kOpening_bytes), '\0');
    read_input_piece(in, file, 0, bytes.data(), bytes.size());
    return picture_size({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}).has_value();
}

}  // namespace

std::vector<Path> mesh_folders(const Path& file) {
    std::error_code error;
    std::vector<Path> out{
        std::filesystem::weakly_canonical(std::filesystem::absolute(file).parent_path(), error)};
    const Path real = std::filesystem::canonical(file, error).parent_path();
    if (!error && real != out.front()) out.push_back(real);
    return out;
}

GrantedFile granted_file(const Path& mesh, const FileName& name) {
    const FoundFile found = sought(mesh, name);
    if (found.file.empty()) return {};
    std::error_code error;
    const Path real = std::filesystem::canonical(found.file, error);
    const std::string ending = real.extension().string();
    try {
        if (is_same_word(ending, ".mtl") || is_same_word(ending, ".bin") || opens_as_picture(real))
            return {real, found.whole, {}};
    } catch (const InputError& refusal) {
        return {real, found.whole, std::string(": ") + refusal.what()};
    }
    return {real, found.whole,
            " lies outside the mesh's folder, at " + harmless(real.string()) +
                "; accepted there: a picture, materials (.mtl), a buffer (.bin)"};
}

std::optional<Path> NamedFiles::find(const FileName& name, const std::string& what) {
    const auto known = granted_.find(name);
    if (known != granted_.end() && !known->second.file.empty()) {
        if (!known->second.refusal.empty()) throw InputError(what + known->second.refusal);
        if (!known->second.whole) remark(what, known->second.file);
        return known->second.file;
    }
    const FoundFile found = sought(mesh_, name);
    const bool outside = found.file.empty() ? leads_outside(mesh_, name) : !is_inside(mesh_, found.file);
    if (outside && known == granted_.end() && wanted_.size() < kMaxWantedFiles) {
        wanted_.push_back(name);
        throw InputError(what + " lies outside the mesh's folder");
    }
    if (found.file.empty()) return {};
    if (outside)
        throw InputError(what + " lies outside the mesh's folder, at " + harmless(found.file.string()));
    if (!found.whole) remark(what, found.file);
    return found.file;
}

std::optional<std::filesystem::path> NamedFiles::find_for_mesh(const FileName& name,
                                                               const std::string& what) {
    try {
        return find(name, what);
    } catch (const InputError& refusal) {
        throw InputError(mesh_.string() + ": " + refusal.what());
    }
}

void NamedFiles::remark(const std::string& what, const Path& file) {
    const Path near = file.lexically_normal().lexically_proximate(mesh_.parent_path().lexically_normal());
    const std::string text = what + ": no file of that name; taken: " + in_quotes(near.string());
    if (std::find(remarks_.begin(), remarks_.end(), text) == remarks_.end()) remarks_.push_back(text);
}

std::string without_percents(std::string_view uri) {
    const auto digit = [](char c) {
        if (c >= '0' && c <= '9') return c - '0';
        const char s = small_letter(c);
        return s >= 'a' && s <= 'f' ? s - 'a' + 10 : -1;
    };
    std::string out;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool is_code =
            uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0;
        out += is_code ? static_cast<char>(16 * digit(uri[i + 1]) + digit(uri[i + 2])) : uri[i];
        if (is_code) i += 2;
    }
    return out;
}

}  // namespace hilcam
