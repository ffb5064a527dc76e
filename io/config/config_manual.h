#pragma once
// The manual of configuration files: what they accept, in words.

#include <string>
#include <string_view>

#include "render/vocabulary/config_field.h"

namespace hilcam {

// "0 to 5", "1 or more", "5 or less", "any number".
std::string accepted(const Range& range);

// The value that a key "a.b.c" has now, as a file would give it; empty when there is no such key, or when it
// has no short text (paths, sections, curves).
std::string value_text(const SectionField& root, std::string_view key);

// A Markdown table of the keys: key, accepted, default, meaning. Nested sections follow as rows
// "section.key", list elements as "list.N.key". A section with the same keys as an earlier one is folded into
// a row that names that one and the defaults that are others. prefix: "camera.shutter" for that key and all
// below it alone; empty: all. Throws InputError for one that is none.
std::string config_manual(const SectionField& root, std::string_view prefix = {});
// The same keys, none folded, as a JSON list of {key, kind, accepted, default, required, meaning}.
std::string config_manual_json(const SectionField& root, std::string_view prefix = {});

}  // namespace hilcam
