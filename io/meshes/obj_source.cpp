#include "io/meshes/obj_source.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>

#include "io/files/text_lines.h"
#include "io/meshes/mesh_import.h"
#include "io/meshes/mesh_precheck.h"
#include "io/system/confined.h"
#include "io/system/text_mark.h"

namespace hilcam {
namespace {

// More than any OBJ names; each is searched on the disk.
constexpr std::size_t kMaxLibraries = 1000;

bool is_mtl(std::string_view word) {
    constexpr std::string_view kEnding = ".mtl";
    return word.size() >= kEnding.size() &&
           std::equal(kEnding.begin(), kEnding.end(), word.end() - kEnding.size(),
                      [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

std::string_view without_quotes(std::string_view name) {
    const bool quoted = name.size() > 1 && name.front() == '"' && name.back() == '"';
    return quoted ? name.substr(1, name.size() - 2) : name;
}

// A name may have blanks, and a line several names: each extends to the next word with the ending of such
// files.
void add_libraries(std::string_view rest, std::vector<std::string>& out) {
    std::size_t begin = 0;
    for (std::size_t at = 0; at < rest.size();) {
        const std::size_t end = std::min(rest.find_first_of(" \t", at), rest.size());
        if (is_mtl(without_quotes(rest.substr(begin, end - begin))) || end == rest.size()) {
            out.emplace_back(without_quotes(trimmed(rest.substr(begin, end - begin))));
            begin = std::min(rest.find_first_not_of(" \t", end), rest.size());
        }
        at = std::min(rest.find_first_not_of(" \t", end), rest.size());
    }
}

class ObjWriter {
  public:
    ObjWriter(std::string_view text, const std::string& name) : rest_(text), name_(name) {
        out_.text.reserve(text.size() + text.size() / 8);
    }

    ObjSource write() {
        for (std::string_view line; next(line);) add(line);
        return std::move(out_);
    }

  private:
    std::string_view rest_;
    const std::string& name_;
    ObjSource out_;
    std::string joined_;  // continued lines, joined
    int line_ = 0, begin_ = 0;

    // Returns the next line of the file, which ends with a line feed, a carriage return or both.
    std::string_view physical_line() {
        const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
        const std::string_view line = rest_.substr(0, end);
        const std::size_t mark = rest_.substr(end).starts_with("\r\n") ? 2 : 1;
        rest_.remove_prefix(std::min(end + mark, rest_.size()));
        ++line_;
        return line;
    }
    // Gets the next line without its blanks; a line that ends with \ continues in the next.
    bool next(std::string_view& line) {
        if (rest_.empty()) return false;
        begin_ = line_ + 1;
        line = trimmed(physical_line());
        if (!line.ends_with('\\')) return true;
        joined_ = line.substr(0, line.size() - 1);
        while (!rest_.empty()) {
            line = trimmed(physical_line());
            const bool goes_on = line.ends_with('\\');
            joined_.append(" ").append(line.substr(0, line.size() - (goes_on ? 1 : 0)));
            if (!goes_on) break;
        }
        line = trimmed(joined_);
        return true;
    }

    [[noreturn]] void refuse(std::string_view found, const std::string& accepted) const {
        throw InputError(name_ + ":" + std::to_string(begin_) + ": found " + in_quotes(found) +
                         "; accepted: " + accepted);
    }

    void add(std::string_view line) {
        const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
        const std::string_view word = line.substr(0, end), rest = trimmed(line.substr(end));
        if (word == "v") return add_numbers(line, "v", rest, 3, 6);
        if (word == "vn") return add_numbers(line, "vn", rest, 3, 3);
        if (word == "vt") return add_numbers(line, "vt", rest, 1, 3);
        if (word == "f" || word == "fo") return add_indices(line, "f", rest);
        if (word == "l" || word == "p") return add_indices(line, word, rest);
        if (word == "mtllib") {
            add_libraries(rest, out_.libraries);
            if (out_.libraries.size() > kMaxLibraries)
                throw InputError(name_ + ": names more than " + std::to_string(kMaxLibraries) +
                                 " files of materials");
            return;
        }
        if (!line.empty() && word.front() != '#') out_.text.append(line) += '\n';
    }

    // Calls `use` for each word up to a comment, and returns how many there were.
    template <class Use>
    static std::size_t each_word(std::string_view rest, const Use& use) {
        std::size_t count = 0;
        for (std::size_t at = 0; at < rest.size();) {
            const std::size_t end = std::min(rest.find_first_of(" \t", at), rest.size());
            if (rest[at] == '#') break;
            use(rest.substr(at, end - at), count++);
            at = std::min(rest.find_first_not_of(" \t", end), rest.size());
        }
        return count;
    }

    // assimp accepts 3, 4 and 6 numbers for a vertex, 2 and 3 for texture coordinates.
    void add_numbers(std::string_view line, std::string_view keyword, std::string_view rest,
                     std::size_t least, std::size_t most) {
        const std::size_t found = each_word(rest, [](std::string_view, std::size_t) {});
        if (found < least) refuse(line, std::to_string(least) + " numbers or more");
        const std::size_t taken = found == 5 ? 3 : std::min(found, most);
        out_.text.append(keyword);
        each_word(rest, [&](std::string_view number, std::size_t i) {
            if (i < taken) add_number(number);
        });
        out_.text.append(taken == 1 ? " 0\n" : "\n");
    }
    void add_number(std::string_view number) {
        out_.text.append(number.starts_with('.') ? " 0" : " ");
        const std::size_t begin = out_.text.size();
        out_.text.append(number);
        // Exponents of Fortran's double precision.
        const std::size_t d = out_.text.find_first_of("dD", begin);
        if (d == std::string::npos || d == begin) return;
        const char before = out_.text[d - 1];
        if (before == '.' || (before >= '0' && before <= '9')) out_.text[d] = 'e';
    }

    // Corners are v, v/vt, v//vn or v/vt/vn, each a non-zero integer.
    void add_indices(std::string_view line, std::string_view keyword, std::string_view rest) {
        out_.text.append(keyword);
        each_word(rest, [&](std::string_view corner, std::size_t) {
            out_.text += ' ';
            for (std::size_t at = 0, part = 0; at <= corner.size(); ++part) {
                const std::size_t end = std::min(corner.find('/', at), corner.size());
                if (part > 0) out_.text += '/';
                if (part > 2) refuse_corners(line);
                add_index(line, corner.substr(at, end - at), part == 0);
                at = end + 1;
            }
        });
        out_.text += '\n';
    }
    [[noreturn]] void refuse_corners(std::string_view line) const {
        refuse(line, "corners v, v/vt, v//vn or v/vt/vn, counted from 1, or from -1 back");
    }
    void add_index(std::string_view line, std::string_view index, bool required) {
        const bool is_negative = index.starts_with('-');
        std::string_view digits = index.substr(is_negative || index.starts_with('+') ? 1 : 0);
        const bool is_whole =
            std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
        digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
        if (index.empty() && !required) return;
        if (!is_whole || digits.empty() || digits.size() > 9) refuse_corners(line);
        out_.text.append(is_negative ? "-" : "").append(digits);
    }
};

// Adds a library: its text, and the folder of its materials' textures.
void add_library(const std::filesystem::path& file, ObjMaterials& materials, ObjLibraries& out) {
    const std::string bytes = read_input_file(file, mesh_kind());
    allow_more(kMeshMemoryPerByte * bytes.size(), kMeshCpu_s_byte * static_cast<double>(bytes.size()));
    std::string text(without_mark(bytes, file.string()));
    std::replace(text.begin(), text.end(), '\r', '\n');
    materials.add(text, file.string());
    TextLines lines(text, file.string());
    for (std::string_view line; lines.next(line);) {
        line = trimmed(line);
        if (line.starts_with("newmtl"))
            out.folder_of_material.insert_or_assign(std::string(trimmed(line.substr(6))), file.parent_path());
        if (!line.empty()) out.text.append(line) += '\n';
    }
}

}  // namespace

ObjSource plain_obj(std::string_view text, const std::string& name) {
    return ObjWriter(without_mark(text, name), name).write();
}

ObjLibraries read_obj_libraries(const ObjSource& obj, NamedFiles& files) {
    const std::string mesh = files.mesh().string();
    ObjLibraries out;
    ObjMaterials materials;
    materials.add(obj.text, mesh);
    std::set<std::filesystem::path> read;
    for (const std::string& name : obj.libraries) {
        const auto file = files.find_for_mesh({name, {}}, "materials " + in_quotes(name));
        if (!file)
            out.missing.push_back(name);
        else if (read.insert(*file).second)
            add_library(*file, materials, out);
    }
    if (!read.empty() || out.missing.empty()) return out;
    const std::filesystem::path own = std::filesystem::path(files.mesh()).replace_extension(".mtl");
    std::error_code error;
    if (!std::filesystem::exists(own, error)) return out;
    files.remark("materials " + in_quotes(out.missing.front()), own);
    add_library(own, materials, out);
    out.missing.clear();
    return out;
}

}  // namespace hilcam
