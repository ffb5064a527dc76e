#pragma once
// Imports mesh files of all kinds but shapes in this process. Only the child of mesh_file.cpp and fuzzing
// call it. glTF has its own reader (gltf_import.h); the others go through assimp (mesh_scene.h).

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/meshes/named_files.h"
#include "io/system/input_file.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

// Returns the limits with which mesh files, and files that they name, are opened.
const InputKind& mesh_kind();
// Processor time allowed per byte of a mesh file: 100 times what large files need.
inline constexpr double kMeshCpu_s_byte = 3e-6;
// Memory allowed per byte: assimp's objects for a line of an OBJ are some tens of times its size.
inline constexpr std::uint64_t kMeshMemoryPerByte = 64;

// A node of a file's tree; in file order, parents first.
struct MeshNode {
    std::string name;
    std::uint32_t depth = 0;      // below the root
    std::uint64_t triangles = 0;  // its own, without the nodes below it
};
// A mesh with facts about its file.
struct MeshContents {
    Mesh mesh;
    std::vector<MeshNode> nodes;
    // Triangles with two corners at the same place, which the mesh leaves out.
    std::uint64_t collapsed_triangles = 0;
    // Material libraries that an OBJ names and that are missing.
    std::vector<std::string> missing_materials = {};
    // Textures on triangles that are missing or do not decode, a line each; the surfaces lack them.
    std::vector<std::string> unreadable_textures = {};
    // Each says that something was read as another thing, or left out.
    std::vector<std::string> remarks = {};
    // Facets of an STL with a normal opposite to the order of their corners, and with one more than 26
    // degrees (a cosine of 0.9) away from it. The order is used.
    std::uint64_t opposed_facets = 0, leaning_facets = 0;
};
// Does the work of load_mesh_contents() (mesh_file.h). files: the mesh's; kind: as below.
MeshContents import_mesh_contents(NamedFiles& files, const std::string& kind);

// Does the work of load_mesh_parts() (mesh_file.h). kind: the ending, in lower case. Throws std::bad_alloc
// when limited memory runs out.
std::vector<Mesh> import_mesh_parts(NamedFiles& files, const std::string& kind,
                                    std::span<const std::string> nodes);

}  // namespace hilcam
