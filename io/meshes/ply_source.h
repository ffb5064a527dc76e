#pragma once
// PLY files in the form that assimp reads rightly (G. Turk, "The PLY Polygon File Format", 1994): triangle strips become triangles, comments,
// `obj_info` and elements that assimp does not know are left out, and binary data that begin with a byte that looks like the end of a line keep it.

#include <string>
#include <string_view>

namespace hilcam {

// Throws InputError that begins with `name` for a header that does not end or says what cannot be: an element twice, faces and strips
// beside each other, a strip with an index that is none.
std::string plain_ply(std::string_view ply, const std::string& name);

}  // namespace hilcam
