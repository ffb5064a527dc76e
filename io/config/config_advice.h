#pragma once
// What a message says about a key that is not known.

#include <string>
#include <string_view>

#include "render/vocabulary/config_field.h"

namespace hilcam {

// "; nearest known key: ...; known keys: ...", or that the key's unit is another here.
std::string advice_for(std::string_view key, const Fields& known);

}  // namespace hilcam
