#pragma once
// A glTF 2.0 file: its JSON, and the bytes of its buffers, which are in the file itself, as base64 in the
// JSON, or in other files. Nothing is trusted: every index, length and name is checked where it is used, and
// refused in one line.
//
// A required extension that this reader does not know refuses the file and is named (glTF 2.0, section 3.12).

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

    // kind: ".glb" or ".gltf". Throws InputError, one line that names the file.
    GltfDocument(NamedFiles& files, const std::string& kind);

    const std::filesystem::path& file() const { return files_.mesh(); }
    const Json& root() const { return root_; }
    [[noreturn]] void refuse(const std::string& what) const;

    // Returns a list of the root; an empty one when it is missing.
    const Json& list(const char* name) const;
    // Returns the object at an index of such a list. Throws InputError when there is none: "meshes[7]: there
    // is none".
    const Json& at(const char* name, std::uint64_t index) const;
    // Returns a member that is an index or a count; nothing when it is missing. Throws InputError when it is
    // anything else.
    std::optional<std::uint64_t> whole(const Json& object, const char* key, const std::string& where) const;
    std::uint64_t required_whole(const Json& object, const char* key, const std::string& where) const;
    // Reads one number, or as many as `out` has room for; false when the member is missing. Throw InputError
    // when there are more or fewer numbers, or one is not finite.
    bool number(const Json& object, const char* key, const std::string& where, float& out) const;
    bool numbers(const Json& object, const char* key, const std::string& where, std::span<float> out) const;

    // Returns the bytes of a buffer view, decompressed if necessary (EXT_meshopt_compression,
    // KHR_meshopt_compression).
    GltfBytes view(std::uint64_t index);
    // Returns the bytes that a URI of this file names: data inside it, or a file, opened as `kind`. Throws
    // InputError that begins with `what`, without the mesh's name.
    std::string bytes_at(const std::string& uri, const InputKind& kind, const std::string& what) const;

  private:
    NamedFiles& files_;
    std::string bytes_;  // the whole file, with the binary chunk of a GLB
    GltfBytes binary_;
    bool has_binary_ = false;
    Json root_;
    std::map<std::uint64_t, std::string> buffers_;                 // those read so far
    std::map<std::uint64_t, std::vector<std::uint8_t>> unpacked_;  // decompressed views

    void require_extensions() const;
    GltfBytes buffer(std::uint64_t index);
    // `of` is a buffer view, or an object in its place that says where the compressed bytes are.
    GltfBytes part_of_buffer(const Json& of, const std::string& where);
    GltfBytes unpacked(std::uint64_t index, const Json& compression);
};

// Returns an extension of an object, or null.
const GltfDocument::Json* gltf_extension(const GltfDocument::Json& object, const char* name);
// Returns a member of an object; null when either is missing.
const GltfDocument::Json* gltf_member(const GltfDocument::Json& object, const char* name);
// Returns a value for messages; of a list or an object, its kind only.
std::string gltf_shown(const GltfDocument::Json& value);
// Returns a text member of an object; empty when it is missing.
std::string gltf_text(const GltfDocument::Json& object, const char* name);

}  // namespace hilcam
