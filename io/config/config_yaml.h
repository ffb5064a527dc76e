#pragma once
// Configuration files: YAML into structs through their field lists (render/vocabulary/config_field.h). YAML is known
// here, to yaml_place.h, yaml_value.h and yaml_flag.h, and to no other unit.
//
// Every error is one InputError line: file:line:column, the key's path, what was found, what is accepted.
// Keys that are unknown name the nearest known one. A section may be given as the path of another file,
// relative to the naming file, or as the name of a shipped part (io/system/shipped_parts.h); a list of sections, too, which that
// file then has under the same key. An override "a.b.0.c=VALUE" replaces a value before it is read; VALUE is YAML;
// errors in it name "--set".

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "io/config/key_places.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

// Reads a file of at most 4 MiB into the section. places: gets where each key is given, before the section's own check;
// may be null. Owner thread.
void read_config(const std::filesystem::path& file, const SectionField& root,
                 std::span<const std::string> overrides = {}, KeyPlaces* places = nullptr);
// The same from memory; `name` stands for the file in messages, relative paths are taken from `folder`.
void read_config_text(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                      const SectionField& root, std::span<const std::string> overrides = {});

// True when a file is a mapping with this key at its top, which tells what kind of file it is. False for one
// that cannot be read: read_config() says why.
bool has_top_level_key(const std::filesystem::path& file, const std::string& key);

}  // namespace hilcam
