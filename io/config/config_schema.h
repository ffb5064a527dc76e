#pragma once
// Describes configuration files by a JSON Schema (draft 2020-12) for editors and other checkers.
//
// The schema says which keys exist, their types, ranges and words, and which are required. It does not say
// how keys depend on each other (validate()), or what the named files contain. It has each choice in its
// canonical spelling only, and no key without a value, which the reader treats as a key that is not given.

#include <string>
#include <string_view>

#include "render/vocabulary/config_field.h"

namespace hilcam {

// prefix: "camera" for the schema of a file with that section; empty: the whole. title: what such a file is.
// Throws InputError when no section has that key.
std::string config_schema(const SectionField& root, std::string_view prefix, const std::string& title);

}  // namespace hilcam
