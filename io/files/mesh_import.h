#pragma once
// Mesh files through assimp, in this process: no caller but the child that mesh_file.cpp makes, and fuzzing.
// The only unit that knows assimp.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/system/input_file.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

// The kind as which mesh files, and the files that they name, are opened.
const InputKind& mesh_kind();
// The processor time that a byte of a mesh file may cost: a hundred times what large files take a megabyte.
inline constexpr double kMeshCpu_s_byte = 3e-6;
// A line of an OBJ becomes objects some tens of times its size.
inline constexpr std::uint64_t kMeshMemoryPerByte = 64;

// Returns the folders in and below which a mesh and what it names have to lie: the one that the file is named in, and the one that it is in
// where that is a link.
std::vector<std::filesystem::path> mesh_folders(const std::filesystem::path& file);

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
