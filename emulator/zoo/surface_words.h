#pragma once
// Materials for the surfaces of a mesh that nobody has described: by the words in their names, else by what
// the mesh file itself says.

#include <string>
#include <string_view>

#include "render/vocabulary/mesh.h"

namespace hilcam {

// Returns the name of a shipped material (configs/materials) for a surface: the first word of a fixed list that its name
// contains, in capitals or not; without one bare aluminium for what the file calls a metal, and white paint for the rest.
std::string_view shipped_material_for(const MeshSurface& surface);

}  // namespace hilcam
