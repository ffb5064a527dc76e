#pragma once
// Mesh files of all kinds but shapes, in this process: no caller but the child that mesh_file.cpp makes, and fuzzing. glTF has a
// reader of its own (gltf_import.h), the others are read through assimp, which no other unit knows.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/files/mesh_folder.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

// A node of a file's tree, in the order of the file, parents first.
struct MeshNode {
    std::string name;
    std::uint32_t depth = 0;      // below the root
    std::uint64_t triangles = 0;  // its own, without those of the nodes below
};
// A mesh with what its file has beside the triangles.
struct MeshContents {
    Mesh mesh;
    std::vector<MeshNode> nodes;
    // Triangles with two corners at one place; the mesh is without them.
    std::uint64_t collapsed_triangles = 0;
    // Files of materials that an OBJ names and that are not there.
    std::vector<std::string> missing_materials = {};
};
// Does what load_mesh_contents() of mesh_file.h does; `kind` as below.
MeshContents import_mesh_contents(const std::filesystem::path& file, const std::string& kind);

// Does what load_mesh_parts() of mesh_file.h does. `kind`: the ending, in small letters. std::bad_alloc when
// memory is limited and runs out.
std::vector<Mesh> import_mesh_parts(const std::filesystem::path& file, const std::string& kind,
                                    std::span<const std::string> nodes);

}  // namespace hilcam
