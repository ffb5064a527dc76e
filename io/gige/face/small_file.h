#pragma once
// A file of limited size, read whole.

#include <filesystem>
#include <string>

namespace hilcam {

// Throws InputError when the file cannot be read or has more bytes.
std::string read_small_file(const std::filesystem::path& file, std::size_t max_bytes);

}  // namespace hilcam
