#pragma once
// Reads the first file of a zip (PKWARE APPNOTE 6.3): stored or deflated, not encrypted, not split.

#include <cstdint>
#include <span>
#include <string>

namespace hilcam {

bool is_zip(std::span<const std::uint8_t> bytes);
// name: for messages. Throws InputError for a zip that is cut or damaged, has none of the two methods, or
// unzips to more than max_bytes.
std::string unzip_first(std::span<const std::uint8_t> bytes, std::size_t max_bytes, const std::string& name);

}  // namespace hilcam
