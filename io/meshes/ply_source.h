#pragma once
// Rewrites PLY files so that assimp reads them correctly (G. Turk, "The PLY Polygon File Format", 1994).
// Triangle strips become triangles; comments, `obj_info` and elements that assimp does not know are left out.
// Binary data that begin with a byte that looks like the end of a line keep that byte.

#include <string>
#include <string_view>

namespace hilcam {

// Throws InputError that begins with `name` for a header that does not end or is inconsistent: an element
// twice, both faces and strips, a strip with an invalid index.
std::string plain_ply(std::string_view ply, const std::string& name);

}  // namespace hilcam
