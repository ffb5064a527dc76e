#pragma once
// Data that a URI holds itself (RFC 2397), as glTF has them. Names of files are named_files.h's.

#include <optional>
#include <string>
#include <string_view>

namespace hilcam {

// Returns the bytes of a URI that holds them as base64; nothing where it is another or its base64 is none.
std::optional<std::string> decoded_data_uri(std::string_view uri);

}  // namespace hilcam
