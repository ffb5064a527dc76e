#pragma once
// STL files in the form that assimp reads rightly: in text without solids that have no facet, with words in small letters; binary
// ones without what lies behind their last triangle (3D Systems, "StereoLithography Interface Specification", 1989).

#include <string>
#include <string_view>
#include <vector>

namespace hilcam {

// True for an STL in text. Binary ones may begin with the same word, but their numbers are no ASCII.
bool is_stl_text(std::string_view stl);

// Throws InputError that begins with `name` for a binary file that is shorter than it says. remarks: gets what was left out.
std::string plain_stl(std::string_view stl, const std::string& name, std::vector<std::string>& remarks);

}  // namespace hilcam
