#pragma once
// Loads mesh files: glTF and GLB, OBJ, STL, PLY, and shapes of small bodies (shape_table.h, dsk_shape.h).
// They are read in a child process with limits (confined.h), so that a file costs a bounded amount and cannot
// end the program.
//
// - The node tree is flattened with its transforms, and polygons become triangles. Points, lines and exactly
//   degenerate triangles (a repeated corner) are dropped.
// - Coordinates are metres (km in a shape kernel), in the file's axes (glTF: +y up).
// - Normals are the file's; a mesh without normals is shaded flat. Facets of an STL are flat; the order of
//   their corners gives the normal.
// - Materials get glTF metallic-roughness values, or the nearest that the format has. Textures may be
//   embedded or in files (named_files.h); only those on triangles are read. docs/materials.md lists which
//   looks are used; Mesh::left_out has the rest.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/meshes/mesh_import.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

// Throws InputError, one line that names the file, when the file is missing, of an unknown kind or malformed;
// has no triangle or a vertex that is not finite; has textures that are missing, do not decode or are too
// large (picture_file.h); has more than 10,000 surfaces, 200,000 nodes, 100 million triangles, or 10,000
// corners of a polygon; or needs more memory or time than a file of its size may.
Mesh load_mesh(const std::filesystem::path& file);
// Loads the same in parts, all in the file's axes. The first has what no name matches; then there is one for
// each name, the nodes of that name with all nodes below them ("*" at the end matches any ending). surface:
// the code of a shape kernel's surface, if it has several. Throws InputError also for a name that matches no
// node, with a list of the nodes.
std::vector<Mesh> load_mesh_parts(const std::filesystem::path& file, std::span<const std::string> nodes,
                                  std::optional<int> surface = {});
// Loads the whole mesh with facts about the file: its nodes, or a shape kernel's segments, and what was left
// out. Throws InputError as above, except for textures: it lists all unreadable ones.
MeshContents load_mesh_contents(const std::filesystem::path& file, std::optional<int> surface = {});

}  // namespace hilcam
