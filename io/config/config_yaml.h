#pragma once
// Reads configuration files: YAML into structs through their field lists (render/vocabulary/config_field.h).
// Only this unit, yaml_place.h, yaml_value.h and yaml_flag.h know YAML.
//
// Every error is an InputError, one line: file:line:column, the key's path, what was found, what is accepted.
// For an unknown key it names the nearest known one. A section may be given as the path of another file,
// relative to the file that names it, or as the name of a shipped part (io/system/shipped_parts.h). So may a
// list of sections, which that file has under the same key. An override "a.b.0.c=VALUE" replaces a value
// before it is read. VALUE is YAML; errors in it name "--set".

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "io/config/key_places.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

// Reads a file of at most 4 MiB into the section. places: gets the place of each key that is given, before
// the section's own check; may be null. Owner thread.
void read_config(const std::filesystem::path& file, const SectionField& root,
                 std::span<const std::string> overrides = {}, KeyPlaces* places = nullptr);
// Reads the same from memory; `name` stands for the file in messages, and relative paths start at `folder`.
void read_config_text(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                      const SectionField& root, std::span<const std::string> overrides = {});

// True when a file is a mapping with this key at its top, which identifies the kind of file. False for a file
// that cannot be read; read_config() gives the reason.
bool has_top_level_key(const std::filesystem::path& file, const std::string& key);

}  // namespace hilcam
