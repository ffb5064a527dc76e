#pragma once
// An OBJ, PLY or STL in memory as assimp is to read it, with what assimp drops of it.

#include <string>
#include <vector>

#include "io/meshes/named_files.h"
#include "io/meshes/obj_maps.h"
#include "io/meshes/obj_source.h"

namespace hilcam {

struct MeshSource {
    std::string path, bytes;      // the path's ending says what it is
    ObjLibraries libraries = {};  // an OBJ has some
    std::vector<std::string> remarks = {};
    bool is_flat = false;       // the corners' order is the normal
    ObjMaps maps = {};          // an OBJ may have some
    bool whole_colors = false;  // colours at corners are a picture's, not linear
};

// The name by which the mesh asks for an OBJ's materials, all of them in one text.
inline constexpr const char* kMeshMaterials = "hilcam_materials.mtl";

// Reads the mesh and, for an OBJ, its libraries of materials. kind: the ending, in small letters. InputError.
MeshSource mesh_source_of(NamedFiles& files, const std::string& kind);

}  // namespace hilcam
