#pragma once
// `hilcam mesh FILE`: how large a mesh is, what it consists of, and what is wrong with it. Pure functions.
//
// Vertices at the same position count as one, whatever their normals and texture coordinates, because
// exporters give each corner a vertex of its own. An edge joins two such positions:
//   open           belongs to one triangle: the surface ends there
//   inconsistent   two triangles use it in the same direction: one of them is flipped against the other
//   crowded        belongs to three triangles or more
//
// A shell is a set of triangles connected by edges. A shell without open or inconsistent edges is inside out
// if its volume is negative (the sum of its triangles' tetrahedra with the origin).

#include <cstdint>
#include <string>
#include <vector>

#include "io/meshes/mesh_file.h"

namespace hilcam {

struct SurveyedSurface {
    std::string name;
    std::uint64_t triangles = 0;
    double area_m2 = 0;
    bool textured = false;
};

struct MeshSurvey {
    std::string file;
    Vec3d min_m, max_m;
    std::uint64_t triangles = 0, vertices = 0, places = 0;
    std::vector<SurveyedSurface> surfaces;
    std::vector<MeshNode> nodes;
    std::uint64_t shells = 0, inverted_shells = 0;
    std::uint64_t open_edges = 0, inconsistent_edges = 0, crowded_edges = 0;
    std::uint64_t collapsed_triangles = 0;  // two corners at one position; not drawn
    std::uint64_t sliver_triangles = 0;     // three corners on a line
    std::uint64_t repeated_triangles = 0;   // same corners as another triangle
    std::uint64_t opposed_normals = 0;      // triangles with stored normals that point backwards
    // STL facets with a stored normal more than 26 degrees off the normal of their corners.
    std::uint64_t leaning_normals = 0;
    bool has_normals = false;
    bool probably_mm = false;
    // Step of single precision at the farthest coordinate if it exceeds a ten-thousandth of the mesh's size;
    // else 0.
    double coarse_step_m = 0;
    std::vector<std::string> missing_materials;
    std::vector<std::string> unreadable_textures;
    std::vector<std::string> remarks;   // each says what was read as something else, or left out
    std::vector<std::string> left_out;  // Mesh::left_out
};

// file: name for messages.
MeshSurvey survey_mesh(const MeshContents& contents, const std::string& file);
// Returns what is wrong, one line each. Some meshes are open on purpose.
std::vector<std::string> problems_of(const MeshSurvey& survey);

std::string to_text(const MeshSurvey& survey);
std::string to_json(const MeshSurvey& survey);

}  // namespace hilcam
