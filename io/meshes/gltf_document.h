#pragma once
// A glTF 2.0 file: its JSON, and the bytes of its buffers, which may lie in the file, as base64 in the JSON, or in files beside it.
// Nothing of it is believed: an index, a length or a name is checked where it is used, and refused in one line.
//
// A required extension that this reader does not know refuses the file by name (glTF 2.0, section 3.12).

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/meshes/named_files.h"
#include "io/system/input_file.h"

namespace hilcam {

using GltfBytes = std::span<const std::uint8_t>;

class GltfDocument {
  public:
    using Json = nlohmann::json;

    // kind: ".glb" or ".gltf". InputError, one line that names the file.
    GltfDocument(NamedFiles& files, const std::string& kind);

    const std::filesystem::path& file() const { return files_.mesh(); }
    const Json& root() const { return root_; }
    [[noreturn]] void refuse(const std::string& what) const;

    // Returns a list of the root; one that is not there is empty.
    const Json& list(const char* name) const;
    // Returns the object at a place of such a list. InputError where there is none: "meshes[7]: there is none".
    const Json& at(const char* name, std::uint64_t index) const;
    // Returns a member that is an index or a count; nothing where it is not there. InputError where it is something else.
    std::optional<std::uint64_t> whole(const Json& object, const char* key, const std::string& where) const;
    std::uint64_t required_whole(const Json& object, const char* key, const std::string& where) const;
    // Returns a number, or as many of them as `out` has room for; false where there is none. InputError where they are not so
    // many numbers, or not finite.
    bool number(const Json& object, const char* key, const std::string& where, float& out) const;
    bool numbers(const Json& object, const char* key, const std::string& where, std::span<float> out) const;

    // Returns the bytes of a buffer view, decompressed where it is compressed (EXT_meshopt_compression, KHR_meshopt_compression).
    GltfBytes view(std::uint64_t index);
    // Returns the bytes that a URI of this file names: data in it, or a file, which is opened as one of a kind. `what` begins
    // messages, without the mesh's name. InputError without it, too.
    std::string bytes_at(const std::string& uri, const InputKind& kind, const std::string& what) const;

  private:
    NamedFiles& files_;
    std::string bytes_;  // the whole file; a GLB's binary chunk lies in there
    GltfBytes binary_;
    bool has_binary_ = false;
    Json root_;
    std::map<std::uint64_t, std::string> buffers_;                 // those that were asked for
    std::map<std::uint64_t, std::vector<std::uint8_t>> unpacked_;  // decompressed views

    void require_extensions() const;
    GltfBytes buffer(std::uint64_t index);
    // `of`: a buffer view, or what says in its place where compressed bytes lie.
    GltfBytes part_of_buffer(const Json& of, const std::string& where);
    GltfBytes unpacked(std::uint64_t index, const Json& compression);
};

// Returns an extension of an object, or null.
const GltfDocument::Json* gltf_extension(const GltfDocument::Json& object, const char* name);
// Returns a member of an object, or null where either is missing.
const GltfDocument::Json* gltf_member(const GltfDocument::Json& object, const char* name);
// Returns a value as messages have it: a list or an object by its kind alone.
std::string gltf_shown(const GltfDocument::Json& value);
// Returns a text of an object; empty where there is none.
std::string gltf_text(const GltfDocument::Json& object, const char* name);

}  // namespace hilcam
