#pragma once
// URIs as glTF has them: data in the URI itself (RFC 2397), or the name of a file, with its special characters as
// percent signs and two digits (RFC 3986, section 2.1).

#include <optional>
#include <string>
#include <string_view>

namespace hilcam {

// Returns the bytes of a URI that holds them as base64; nothing where it is another or its base64 is none.
std::optional<std::string> decoded_data_uri(std::string_view uri);
// Returns a name without its percent signs. One that is followed by no two digits stays.
std::string decoded_uri(std::string_view uri);

}  // namespace hilcam
