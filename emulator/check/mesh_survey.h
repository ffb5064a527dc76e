#pragma once
// `hilcam mesh FILE`: how large a mesh is, what it is made of, and what is wrong with it. Pure but for the
// text.
//
// Vertices at one place count as one, whatever their normals and places on textures: exporters give each
// corner its own. Over those, an edge is a pair of places:
//   open           one triangle has it: the surface ends there
//   inconsistent   two triangles have it in the same direction: one of them is turned over against the other
//   crowded        three triangles or more have it
// A shell is what hangs together by edges. One without open and inconsistent edges that holds a negative
// volume (the sum of its triangles' tetrahedra to the origin) has all its triangles turned inwards.

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
    std::uint64_t collapsed_triangles = 0;  // two corners at one place; not drawn
    std::uint64_t sliver_triangles = 0;     // three places on a line
    std::uint64_t repeated_triangles = 0;   // on the same places as another
    std::uint64_t opposed_normals = 0;      // triangles whose normals in the file look to their other side
    // An STL stores a normal for each facet. It is more than 26 degrees off the plane of the facet's corners in so many.
    std::uint64_t leaning_normals = 0;
    bool has_normals = false;
    bool probably_mm = false;
    // The step of single precision at the farthest coordinate, where it is more than a ten-thousandth of the
    // mesh's size; else 0.
    double coarse_step_m = 0;
    std::vector<std::string> missing_materials;
    std::vector<std::string> unreadable_textures;
    std::vector<std::string> remarks;   // each says that something was taken for another thing, or left out
    std::vector<std::string> left_out;  // Mesh::left_out
};

// file: for messages.
MeshSurvey survey_mesh(const MeshContents& contents, const std::string& file);
// Says what is wrong, a line each; some meshes mean to be open.
std::vector<std::string> problems_of(const MeshSurvey& survey);

std::string to_text(const MeshSurvey& survey);
std::string to_json(const MeshSurvey& survey);

}  // namespace hilcam
