#pragma once
// Finds the parts that are shipped with the program and have a name: `hilcam run small`, `quality: realtime`.
//
// A kind of part is a folder of the data folder (program_files.h). A part's name is its file's without the
// ending. Any thread; touches nothing but the file system.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hilcam {

struct ShippedKind {
    std::string_view words;   // "qualities", as in `hilcam list`
    std::string_view folder;  // "quality"
    std::string_view use;     // where a name can be given: "quality: NAME"
};

// Returns all kinds, in the order of the list.
std::span<const ShippedKind> shipped_kinds();
// Returns the kind with these words; null: there is none.
const ShippedKind* shipped_kind(std::string_view words);
// Returns the kind of part that a key of a configuration accepts, "more_cameras.0.camera" or "loop.levels.1";
// null: the key accepts none.
const ShippedKind* kind_of_key(std::string_view key);

// Returns the file of a part by its name, in any case. Empty when there is none, or when the name has a
// folder or an ending.
std::filesystem::path shipped_part(const ShippedKind& kind, const std::filesystem::path& name);

struct ShippedPart {
    std::string name;   // "realtime"
    std::string about;  // first sentence of the file's comment; empty: no comment
    std::filesystem::path file;
};
// Returns the parts of a kind, sorted by name.
std::vector<ShippedPart> shipped_parts(const ShippedKind& kind);
// Returns the names of these parts.
std::vector<std::string> shipped_names(const ShippedKind& kind);

// Returns the first sentence of the comment that begins a text file ('#', in a PLY "comment"), without its
// full stop. A line for an editor's schema is skipped.
std::string first_sentence_of(std::string_view text);

// Returns the file of a scenario or camera as users name it: a path, or a word such as "small" for the
// shipped scenarios/small.yaml or cameras/small.yaml. A file at the path itself comes first. When nothing is
// found, the name is returned unchanged.
std::filesystem::path named_config(const std::filesystem::path& name);
// Returns the words that named_config() accepts, scenarios before cameras.
std::vector<std::string> config_names();

}  // namespace hilcam
