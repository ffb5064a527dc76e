#pragma once
// Finds the files that a configuration names.

#include <filesystem>
#include <string>

namespace hilcam {

// Returns the path of a file that a key names, which need not exist. It is relative to the configuration's
// folder. When nothing is there, the shipped file with that path is used, or the shipped part with that name
// (io/system/shipped_parts.h) if the key accepts parts. In a shipped configuration, a file that is not
// shipped is the user's (a mesh to provide, a folder to write to) and relative to the working directory.
std::filesystem::path file_named_from(const std::filesystem::path& folder, const std::string& name,
                                      const std::string& key);

// Returns what a message about a missing name says about shipped parts, with the nearest one; empty for a key
// that accepts none.
std::string shipped_advice(const std::string& key, const std::string& found);

}  // namespace hilcam
