#pragma once
// The options of map_Kd in a material library (MTL; Wavefront, Advanced Visualizer, appendix B1): how a
// texture is placed on its surface.

#include <map>
#include <string>
#include <string_view>

#include "render/vocabulary/vec.h"

namespace hilcam {

struct ObjMap {
    Vec2f offset{0, 0}, scale{1, 1};  // -o and -s: coordinates are scaled, then moved
    bool clamp = false;               // -clamp on: the picture's edge continues

    Vec2f of(Vec2f uv) const { return {scale.x * uv.x + offset.x, scale.y * uv.y + offset.y}; }
};
// Options by material name; materials without options are left out.
using ObjMaps = std::map<std::string, ObjMap, std::less<>>;

// Adds the map_Kd options of a library to `maps`, and returns the library without them. assimp would read a
// file name as the number that an option may have.
std::string take_map_options(std::string_view mtl, ObjMaps& maps);

// True when a PLY file has integer colours, which are sRGB as in pictures; floats are linear.
bool has_whole_colors(std::string_view ply);

}  // namespace hilcam
