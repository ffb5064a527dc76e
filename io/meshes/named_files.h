#pragma once
// Finds the files that a mesh names: materials, textures, buffers. The names come from other machines, so
// they are tried in several ways, each with less of the name:
//
//  1  unchanged, in each folder given for it
//  2  with slashes for backslashes
//  3  the same in any case (ASCII letters)
//  4  the last component only, beside the mesh, in any case
//
// A file found by 3 or 4 gets a remark. A file in the mesh's folders or below is read directly. A file
// outside is only recorded as wanted at first, because the child that reads meshes can read no other folder.
// Its parent then examines the file (granted_file()) and starts a child that may read it as well.

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hilcam {

// Returns the folders in and below which a mesh's files are read directly: the folder in its path and, for a
// symlink, the folder of its target.
std::vector<std::filesystem::path> mesh_folders(const std::filesystem::path& file);

// A name as written in its file, and the folders to search. The mesh's own folder is always searched last.
struct FileName {
    std::string name;
    std::vector<std::filesystem::path> folders;
    auto operator<=>(const FileName&) const = default;
};

// A file outside the mesh's folders that may be read, or the reason why it may not.
struct GrantedFile {
    std::filesystem::path file;  // empty: there is none
    bool whole = false;          // found by its whole name
    std::string refusal;         // rest of a message that begins with the name; empty: it may be read
};
using GrantedFiles = std::map<FileName, GrantedFile>;

// Finds a file outside the mesh's folders, with the parent's rights, and decides whether the child may read
// it. Pictures are recognised by their first bytes, materials (.mtl) and buffers (.bin) by their ending; all
// must be regular files. An untrusted mesh must not open anything else.
GrantedFile granted_file(const std::filesystem::path& mesh, const FileName& name);

// More than any mesh names; for each, a program without limits looks at the disk.
inline constexpr std::size_t kMaxWantedFiles = 1000;

class NamedFiles {
  public:
    explicit NamedFiles(std::filesystem::path mesh, GrantedFiles granted = {})
        : mesh_(std::move(mesh)), granted_(std::move(granted)) {}

    // Returns the file; nothing when there is none. what: begins remarks and messages, such as "texture
    // 'a.png'". Throws InputError for a file outside that may not be read, or that is only wanted.
    std::optional<std::filesystem::path> find(const FileName& name, const std::string& what);
    // Finds the same, with messages that begin with the mesh's name.
    std::optional<std::filesystem::path> find_for_mesh(const FileName& name, const std::string& what);

    const std::filesystem::path& mesh() const { return mesh_; }
    // Returns remarks about files that were found by less than their whole name.
    const std::vector<std::string>& remarks() const { return remarks_; }
    // Returns the names that the parent has to examine.
    const std::vector<FileName>& wanted() const { return wanted_; }
    // Adds a remark that a file is used for something with another name.
    void remark(const std::string& what, const std::filesystem::path& file);

  private:
    std::filesystem::path mesh_;
    GrantedFiles granted_;
    std::vector<std::string> remarks_;
    std::vector<FileName> wanted_;
};

// Returns a URI with its percent escapes decoded (RFC 3986, 2.1): "quad%20%C3%BC.bin" names a file with a
// blank. A % without two hexadecimal digits stays.
std::string without_percents(std::string_view uri);

}  // namespace hilcam
