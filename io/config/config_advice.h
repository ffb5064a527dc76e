#pragma once
// Advice in messages about an unknown key or word.

#include <span>
#include <string>
#include <string_view>

#include "render/vocabulary/config_field.h"

namespace hilcam {

// Returns what helps with a key that is not in `known`, the keys allowed there: "; nearest known key: ...;
// known keys: ...", its new name or replacement (renamed_keys.h), the unit that is used here, the key for a
// data sheet's word (data_sheet_words.h), or its place elsewhere in the configuration. Appends an element to
// each of the root's lists (config_keys.h), so the caller must not use the root afterwards.
std::string advice_for(std::string_view key, const Fields& known, const Fields& root);

// Returns what helps with an unknown whole key: "; nearest: camera.shutter", or where a key with that name
// is.
std::string key_advice(std::string_view whole_key, const Fields& root);

// Returns a guess at the unit of a number, "; in nanometres? here: 0.4", if the converted number is in the
// range; empty when there is no such guess. name: of the key or the column.
std::string unit_advice(std::string_view name, double found, const Range& range);

// Returns the known word within a typing error of at most three letters; empty when there is none.
std::string nearest_of(std::string_view word, std::span<const std::string> known);

}  // namespace hilcam
