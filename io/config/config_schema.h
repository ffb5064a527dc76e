#pragma once
// Describes configuration files by a JSON Schema (draft 2020-12) for editors and checkers of others.
//
// A schema says which keys there are, their types, ranges, words and which are required. What keys must be to
// each other (validate()), and what stands in files that a file names, it does not say. It has each choice in
// its own spelling alone, and no key without a value, which the reader takes for one that is not given.

#include <string>
#include <string_view>

#include "render/vocabulary/config_field.h"

namespace hilcam {

// prefix: "camera" for the schema of a file that holds that section; empty: of the whole. Throws InputError
// when no section has that key. title: what such a file is.
std::string config_schema(const SectionField& root, std::string_view prefix, const std::string& title);

}  // namespace hilcam
