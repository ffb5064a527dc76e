#pragma once
// An OBJ, PLY or STL in memory, rewritten so that assimp reads it correctly, with what assimp would drop.

#include <string>
#include <vector>

#include "io/meshes/named_files.h"
#include "io/meshes/obj_maps.h"
#include "io/meshes/obj_source.h"

namespace hilcam {

struct MeshSource {
    std::string path, bytes;      // the path's ending gives the format
    ObjLibraries libraries = {};  // an OBJ's
    std::vector<std::string> remarks = {};
    bool is_flat = false;       // the order of the corners gives the normal
    ObjMaps maps = {};          // an OBJ's
    bool whole_colors = false;  // colours at corners are sRGB integers, not linear
};

// The name under which the mesh refers to an OBJ's materials, all in one text.
inline constexpr const char* kMeshMaterials = "hilcam_materials.mtl";

// Reads the mesh and, for an OBJ, its material libraries. kind: the ending, in lower case. Throws InputError.
MeshSource mesh_source_of(NamedFiles& files, const std::string& kind);

}  // namespace hilcam
