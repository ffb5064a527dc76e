#pragma once
// Where a mesh and the files that it names may lie, and what reading a byte of them may cost.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/system/input_file.h"

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
// Throws InputError, which begins with `what`, where a file lies outside the folders of the mesh that names it.
void require_in_folders(const std::filesystem::path& mesh, const std::filesystem::path& file,
                        const std::string& what);

}  // namespace hilcam
