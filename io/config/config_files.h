#pragma once
// Finds the files that a configuration names.

#include <filesystem>
#include <string>

namespace hilcam {

// Returns the path of a file that the key of a configuration names: from the folder of that configuration; where nothing is there, the
// shipped file of that path, or the shipped part of that name (io/system/shipped_parts.h), where the key takes one. What a
// shipped file names and is not shipped is the user's, a mesh to bring or a folder to write to: it lies in the working directory.
// The file need not be there.
std::filesystem::path file_named_from(const std::filesystem::path& folder, const std::string& name,
                                      const std::string& key);

// Returns what the message about a name that was not found says of shipped parts, with the nearest one; empty for a key that
// takes none.
std::string shipped_advice(const std::string& key, const std::string& found);

}  // namespace hilcam
