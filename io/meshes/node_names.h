#pragma once
// Assigns nodes to the parts of a mesh by name; readers of files with nodes share it.

#include <span>
#include <string>
#include <vector>

namespace hilcam {

// Returns the index of the first name that matches the node, or -1; "*" at the end of a name matches any
// ending.
int taken_by(std::span<const std::string> names, const std::string& node);
// Returns the message that a part has no triangle, as the rest of a sentence that begins with the file. part:
// as in load_mesh_parts(), -1 for what no name matches.
std::string empty_part(std::span<const std::string> names, int part, std::span<const std::string> nodes);

}  // namespace hilcam
