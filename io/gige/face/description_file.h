#pragma once
// A camera's GenICam description as a file: text, a zip with one XML, or what `arv-tool genicam > file`
// leaves, which has a line before the XML. hilcam serves the text from its first '<' on and does not look
// into it.

#include <filesystem>
#include <string>

namespace hilcam {

inline constexpr std::size_t kMaxDescriptionBytes = std::size_t{32} << 20;

// Throws InputError. name: what the file is called in messages.
std::string read_description(const std::filesystem::path& file);
std::string description_of(const std::string& bytes, const std::string& name);

}  // namespace hilcam
