#pragma once
// The advice of a message about a key, or another word, that is not known.

#include <span>
#include <string>
#include <string_view>

#include "render/vocabulary/config_field.h"

namespace hilcam {

// Returns what helps with a key that is none of `known`, the keys of its place: "; nearest known key: ...;
// known keys: ...", the name that it has now or what replaces it (renamed_keys.h), that its unit is another here, what a data sheet's word is
// here (data_sheet_words.h), or where in the whole configuration it belongs. An element
// is appended to each of the root's lists (config_keys.h): whoever asks for advice reads no further.
std::string advice_for(std::string_view key, const Fields& known, const Fields& root);

// Returns what helps with a whole key that there is not: "; nearest: camera.shutter", or where a key of that
// name is.
std::string key_advice(std::string_view whole_key, const Fields& root);

// Returns what a number may have been meant as, "; in nanometres? here: 0.4", if that lies within the range;
// name: of the key, or of the column. Empty: nothing comes to mind.
std::string unit_advice(std::string_view name, double found, const Range& range);

// The known word that is a slip of the pen away, three letters at most; empty: none.
std::string nearest_of(std::string_view word, std::span<const std::string> known);

}  // namespace hilcam
