#pragma once
// A mesh of the scene that assimp makes of a file: its node tree flattened, its materials, textures and colours.

#include <span>
#include <string>

#include "io/meshes/mesh_import.h"
#include "io/meshes/mesh_source.h"
#include "io/meshes/named_files.h"

struct aiScene;

namespace hilcam {

// Returns the mesh with what the file has beside the triangles. InputError.
MeshContents contents_of_scene(const aiScene& scene, const MeshSource& source, NamedFiles& files);
// Returns one part: that of the node `part` of `nodes`, or for -1 what none of them takes. InputError, also when textures cannot be
// read, all of them in one line.
Mesh part_of_scene(const aiScene& scene, const MeshSource& source, NamedFiles& files,
                   std::span<const std::string> nodes, int part);

}  // namespace hilcam
