#pragma once
// Mesh files: glTF and GLB, OBJ, STL, PLY, and shapes of small bodies (shape_table.h, dsk_shape.h). They are read in a child process with limits (confined.h), so that
// a file can cost no more than it may be worth, and cannot end the program.
//
// The node tree is flattened with its transforms; polygons become triangles; points and lines are left out;
// exactly degenerate triangles (a repeated corner) are dropped. Coordinates are taken as metres (a shape kernel has km), axes as the
// file has them (glTF: +y up). Normals are those of the file; a mesh without any is shaded flat. Materials
// give glTF metallic-roughness values or the nearest the format has; textures may be embedded or in files (named_files.h),
// of which those that triangles have are read. docs/materials.md lists what is taken of a file's looks; Mesh::left_out names the rest.
// The facets of an STL are flat: their corners' order is the normal.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/meshes/mesh_import.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

// Throws InputError, one line that names the file, for: a file that is absent, of an unknown kind or does not
// parse; no triangle; a vertex that is not finite; textures that are missing or do not decode; more than
// 10,000 surfaces, 200,000 nodes, 100 million triangles, or 10,000 corners of a polygon; a texture of too
// many pixels (picture_file.h); more memory or time than a file of its size may take.
Mesh load_mesh(const std::filesystem::path& file);
// The same, taken apart: first what none of the names takes, then for each name the nodes of that name ("*"
// at the end matches any ending) with all below them. All in the file's axes. InputError also for a name that
// takes nothing; the message lists the nodes. surface: the code of a shape kernel's surface, where it has several.
std::vector<Mesh> load_mesh_parts(const std::filesystem::path& file, std::span<const std::string> nodes,
                                  std::optional<int> surface = {});
// The whole mesh with what people ask of a file: its nodes, or a shape kernel's segments, and what was left out.
// InputError as above, but for textures, all of which it lists.
MeshContents load_mesh_contents(const std::filesystem::path& file, std::optional<int> surface = {});

}  // namespace hilcam
