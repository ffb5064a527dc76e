#pragma once
// The manual of configuration files: what they accept, in words.

#include <string>
#include <string_view>

#include "render/vocabulary/config_field.h"

namespace hilcam {

// Returns "0 to 5", "1 or more", "5 or less" or "any number".
std::string accepted(const Range& range);

// Returns the value of the key "a.b.c" as a file would give it. Empty when there is no such key, or when its
// value has no short text (paths, sections, curves).
std::string value_text(const SectionField& root, std::string_view key);

// Returns a Markdown table of the keys: key, accepted, default, meaning. Nested sections follow as rows
// "section.key", list elements as "list.N.key". A section with the same keys as an earlier one becomes one
// row, which names that section and the defaults that differ. prefix: "camera.shutter" for that key and all
// below it; empty: all. Throws InputError for an unknown prefix.
std::string config_manual(const SectionField& root, std::string_view prefix = {});
// Returns the same keys, without such folding, as a JSON list of {key, kind, accepted, default, required,
// meaning}.
std::string config_manual_json(const SectionField& root, std::string_view prefix = {});

}  // namespace hilcam
