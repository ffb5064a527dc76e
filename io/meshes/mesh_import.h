#pragma once
// Mesh files of all kinds but shapes, in this process: no caller but the child that mesh_file.cpp makes, and fuzzing. glTF has a
// reader of its own (gltf_import.h), the others are read through assimp (mesh_scene.h).

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/meshes/named_files.h"
#include "io/system/input_file.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

// The kind as which mesh files, and the files that they name, are opened.
const InputKind& mesh_kind();
// The processor time that a byte of a mesh file may cost: a hundred times what large files take a megabyte.
inline constexpr double kMeshCpu_s_byte = 3e-6;
// A line of an OBJ becomes objects some tens of times its size.
inline constexpr std::uint64_t kMeshMemoryPerByte = 64;

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
    // Textures that its triangles have and that are missing or do not decode, a line each; the surfaces are without them.
    std::vector<std::string> unreadable_textures = {};
    // Each says that something was taken for another thing, or left out.
    std::vector<std::string> remarks = {};
    // Facets of an STL whose normals look to the other side than the order of their corners, or lie more than 26 degrees
    // (a cosine of 0.9) from what that order says. The order counts.
    std::uint64_t opposed_facets = 0, leaning_facets = 0;
};
// Does what load_mesh_contents() of mesh_file.h does; `files` are those of the mesh, `kind` as below.
MeshContents import_mesh_contents(NamedFiles& files, const std::string& kind);

// Does what load_mesh_parts() of mesh_file.h does. `kind`: the ending, in small letters. std::bad_alloc when
// memory is limited and runs out.
std::vector<Mesh> import_mesh_parts(NamedFiles& files, const std::string& kind,
                                    std::span<const std::string> nodes);

}  // namespace hilcam
