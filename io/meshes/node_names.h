#pragma once
// Which part of a mesh a node is taken for, by its name: what readers of files with nodes share.

#include <span>
#include <string>
#include <vector>

namespace hilcam {

// Returns which of the names takes a node, or -1; "*" at the end of a name matches any ending.
int taken_by(std::span<const std::string> names, const std::string& node);
// Says that a part has no triangle, as the rest of a sentence that begins with the file. part: as in load_mesh_parts(), -1 for what no name takes.
std::string empty_part(std::span<const std::string> names, int part, std::span<const std::string> nodes);

}  // namespace hilcam
