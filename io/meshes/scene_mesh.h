#pragma once
// Turns assimp's scene of a file into a mesh: the flattened node tree, materials, textures and colours.

#include <span>
#include <string>

#include "io/meshes/mesh_import.h"
#include "io/meshes/mesh_source.h"
#include "io/meshes/named_files.h"

struct aiScene;

namespace hilcam {

// Returns the mesh with facts about its file. Throws InputError.
MeshContents contents_of_scene(const aiScene& scene, const MeshSource& source, NamedFiles& files);
// Returns one part: the nodes that nodes[part] matches or, for -1, what none of them matches. Throws
// InputError, also when textures cannot be read: one line lists them all.
Mesh part_of_scene(const aiScene& scene, const MeshSource& source, NamedFiles& files,
                   std::span<const std::string> nodes, int part);

}  // namespace hilcam
