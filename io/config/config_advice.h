#pragma once
// What a message says about a key, or another word, that is not known.

#include <span>
#include <string>
#include <string_view>

#include "render/vocabulary/config_field.h"

namespace hilcam {

// "; nearest known key: ...; known keys: ...", or that the key's unit is another here.
std::string advice_for(std::string_view key, const Fields& known);

// The known word that is a slip of the pen away, three letters at most; empty: none.
std::string nearest_of(std::string_view word, std::span<const std::string> known);

}  // namespace hilcam
