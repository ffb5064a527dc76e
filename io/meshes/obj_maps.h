#pragma once
// The options of map_Kd in a library of materials (MTL; Wavefront, Advanced Visualizer, appendix B1): how a texture lies on its surface.

#include <map>
#include <string>
#include <string_view>

#include "render/vocabulary/vec.h"

namespace hilcam {

struct ObjMap {
    Vec2f offset{0, 0}, scale{1, 1};  // -o and -s: a place is scaled, then moved
    bool clamp = false;               // -clamp on: the picture's edge goes on

    Vec2f of(Vec2f uv) const { return {scale.x * uv.x + offset.x, scale.y * uv.y + offset.y}; }
};
// Options by the names of materials; materials without any are left out.
using ObjMaps = std::map<std::string, ObjMap, std::less<>>;

// Adds what a library says of its map_Kd, and returns the library with their options left out, since assimp takes the name of the file for
// a number that an option may have.
std::string take_map_options(std::string_view mtl, ObjMaps& maps);

// True where a PLY file gives its colours as whole numbers, which are those of pictures; floats are linear.
bool has_whole_colors(std::string_view ply);

}  // namespace hilcam
