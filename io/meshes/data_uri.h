#pragma once
// Data in a URI itself (RFC 2397), as glTF may have its buffers and pictures.

#include <optional>
#include <string>
#include <string_view>

namespace hilcam {

// Returns the bytes of a URI that holds them as base64; nothing where it is another or its base64 is none.
std::optional<std::string> decoded_data_uri(std::string_view uri);

}  // namespace hilcam
