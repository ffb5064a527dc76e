#pragma once
// Chooses materials for the surfaces of a mesh without a description: by words in their names, or else by the
// mesh file's own material.

#include <string>
#include <string_view>

#include "render/vocabulary/mesh.h"

namespace hilcam {

// Returns the name of a shipped material (configs/materials) for a surface: by the first word of a fixed list
// that its name contains, whatever the case. Otherwise bare aluminium for a metal by the file, and white
// paint for all else.
std::string_view shipped_material_for(const MeshSurface& surface);

}  // namespace hilcam
