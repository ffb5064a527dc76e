#pragma once
// The parts that are shipped with the program and named by a word: `hilcam run small`, `quality: realtime`.
//
// A kind is a folder of the data folder (program_files.h); a part's name is its file's, without the ending.
// Any thread; touches nothing but the file system.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hilcam {

struct ShippedKind {
    std::string_view words;   // "qualities", as `hilcam list` takes it
    std::string_view folder;  // "quality"
    std::string_view use;     // where its names go: "quality: NAME"
};

// All kinds, in the order of the list.
std::span<const ShippedKind> shipped_kinds();
// Returns the kind of these words; null: there is none.
const ShippedKind* shipped_kind(std::string_view words);
// Returns the kind of the parts that a configuration's key takes, "more_cameras.0.camera" or "loop.levels.1";
// null: it takes none.
const ShippedKind* kind_of_key(std::string_view key);

// Returns the file of a part by its name, in capitals or not; empty: there is none, or the name has a folder
// or an ending.
std::filesystem::path shipped_part(const ShippedKind& kind, const std::filesystem::path& name);

struct ShippedPart {
    std::string name;   // "realtime"
    std::string about;  // first sentence of the file's comment; empty: it has none
    std::filesystem::path file;
};
// Returns the parts of a kind by name.
std::vector<ShippedPart> shipped_parts(const ShippedKind& kind);
// The same, their names alone.
std::vector<std::string> shipped_names(const ShippedKind& kind);

// Returns the first sentence of the comment that a text file begins with ('#', in a PLY "comment"), without its
// full stop; a line for an editor's schema is not part of it.
std::string first_sentence_of(std::string_view text);

// A scenario or a camera's file as people name it: a path, or a word such as "small" for the shipped
// scenarios/small.yaml, or cameras/small.yaml. What is there at the path itself comes first; the name as it
// is, when nothing is there.
std::filesystem::path named_config(const std::filesystem::path& name);
// The words that named_config() takes, scenarios before cameras.
std::vector<std::string> config_names();

}  // namespace hilcam
