#pragma once
// Finds the files that a mesh names: materials, textures, buffers. Names were written on other machines, so that
// they are sought in several ways, each with less of the name than the one before:
//
//   1  as it stands, in each of the folders that are given for it
//   2  with slashes for backslashes
//   3  the same without regard to case (letters of ASCII)
//   4  its last word alone, beside the mesh, without regard to case
//
// What was found by 3 or 4 is remarked on. A file in the mesh's folders or below is read as it is. One outside is
// only wanted at first: the child that reads meshes can read no other folder, so that its parent looks at the file
// (granted_file()) and makes a child that may read it, too.

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hilcam {

// Returns the folders in and below which a mesh may read by itself: the one that the file is named in, and the one that it is in
// where that is a link.
std::vector<std::filesystem::path> mesh_folders(const std::filesystem::path& file);

// A name as its file has it, and where to look for it. The mesh's own folder is always looked at last.
struct FileName {
    std::string name;
    std::vector<std::filesystem::path> folders;
    auto operator<=>(const FileName&) const = default;
};

// A file outside the mesh's folders that may be read, or why not.
struct GrantedFile {
    std::filesystem::path file;  // empty: there is none
    bool whole = false;          // found by its whole name
    std::string refusal;         // the rest of a message that begins with the name; empty: it may be read
};
using GrantedFiles = std::map<FileName, GrantedFile>;

// Looks for a file outside the mesh's folders, as the parent may, and says whether the child may read it: pictures by their first bytes,
// materials (.mtl) and buffers (.bin) by their ending, regular files all of them. A mesh from elsewhere shall not open what
// else there is.
GrantedFile granted_file(const std::filesystem::path& mesh, const FileName& name);

// More than any mesh names; each is a look at the disk by a program without limits.
inline constexpr std::size_t kMaxWantedFiles = 1000;

class NamedFiles {
  public:
    explicit NamedFiles(std::filesystem::path mesh, GrantedFiles granted = {})
        : mesh_(std::move(mesh)), granted_(std::move(granted)) {}

    // Returns the file, or nothing where there is none. what: begins remarks and messages, as "texture 'a.png'". Throws InputError
    // for a file outside that may not be read, or that is only wanted.
    std::optional<std::filesystem::path> find(const FileName& name, const std::string& what);
    // The same with messages that begin with the mesh's name.
    std::optional<std::filesystem::path> find_for_mesh(const FileName& name, const std::string& what);

    const std::filesystem::path& mesh() const { return mesh_; }
    // Says of files that were found by less than their whole name which they are.
    const std::vector<std::string>& remarks() const { return remarks_; }
    // Returns the names that the parent is to look at.
    const std::vector<FileName>& wanted() const { return wanted_; }
    // Says that a file was taken for what is named otherwise.
    void remark(const std::string& what, const std::filesystem::path& file);

  private:
    std::filesystem::path mesh_;
    GrantedFiles granted_;
    std::vector<std::string> remarks_;
    std::vector<FileName> wanted_;
};

// Returns the bytes that a URI stands for (RFC 3986, 2.1): "quad%20%C3%BC.bin" names a file with a blank. A % without two
// hexadecimal digits stays.
std::string without_percents(std::string_view uri);

}  // namespace hilcam
