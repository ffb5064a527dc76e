#pragma once
// Rewrites STL files so that assimp reads them correctly: text without solids that have no facet, and with
// keywords in lower case; binary files without bytes after the last triangle (3D Systems, "StereoLithography
// Interface Specification", 1989).

#include <string>
#include <string_view>
#include <vector>

namespace hilcam {

// True for an STL in text. A binary one may begin with the same word, but its numbers are not ASCII.
bool is_stl_text(std::string_view stl);

// Throws InputError that begins with `name` for a binary file that is shorter than it says. remarks: gets
// what was left out.
std::string plain_stl(std::string_view stl, const std::string& name, std::vector<std::string>& remarks);

}  // namespace hilcam
