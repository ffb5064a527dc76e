#pragma once
// glTF 2.0 files (GLB and glTF), in this process: no caller but mesh_import.cpp. The scene that the file shows first, at rest: nodes with their
// instances (EXT_mesh_gpu_instancing), morph targets by their default weights, skins by where their joints' nodes are; hidden nodes
// (KHR_node_visibility) are left out.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/meshes/mesh_import.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

// Does what functions of these names do in mesh_import.h.
MeshContents gltf_contents(NamedFiles& files, const std::string& kind);
std::vector<Mesh> gltf_parts(NamedFiles& files, const std::string& kind, std::span<const std::string> nodes);

}  // namespace hilcam
