#pragma once
// Imports glTF 2.0 files (GLB and glTF) in this process; only mesh_import.cpp calls it. It takes the file's
// default scene at rest: nodes with their instances (EXT_mesh_gpu_instancing), morph targets with default
// weights, and skins posed by their joints' nodes. Hidden nodes (KHR_node_visibility) are left out.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/meshes/mesh_import.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

// These do for glTF what import_mesh_contents() and import_mesh_parts() do (mesh_import.h).
MeshContents gltf_contents(NamedFiles& files, const std::string& kind);
std::vector<Mesh> gltf_parts(NamedFiles& files, const std::string& kind, std::span<const std::string> nodes);

}  // namespace hilcam
