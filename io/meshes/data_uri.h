#pragma once
// Data inside a URI (RFC 2397), in which glTF may have buffers and pictures.

#include <optional>
#include <string>
#include <string_view>

namespace hilcam {

// Returns the bytes of a base64 data URI; nothing for another URI or bad base64.
std::optional<std::string> decoded_data_uri(std::string_view uri);

}  // namespace hilcam
