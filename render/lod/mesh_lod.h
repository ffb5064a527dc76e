#pragma once
// Levels of detail: coarser copies of a mesh, each within a known distance of it, made once by edge collapse
// (meshoptimizer; quadric error of Garland & Heckbert, SIGGRAPH 97).
//
// Surfaces are simplified one by one and keep their borders, so materials keep their areas: a level never
// loses a solar cell, only needless triangles. The normals of flattened wrinkles are kept by triangle for
// what the camera sees (lod_normals.h), and as roughness of a whole surface for everything else.

#include <vector>

#include "render/lod/lod_normals.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

struct MeshLevel {
    Mesh mesh;           // textures are empty: the first level has them. Triangles are in order
    double error_m = 0;  // approximate largest distance between a point of the mesh and the level
    // GGX alpha of the normals that the level has flattened, by surface; added to a material's in quadrature.
    std::vector<float> flattened_alpha;
    std::vector<LodNormals> lod_normals;  // by triangle
};

// Makes the levels from fine to coarse. The error doubles from one to the next; a level is kept if it saves
// two fifths of the triangles. Empty for small meshes. Owner thread; some seconds per million triangles.
std::vector<MeshLevel> coarser_levels(const Mesh& mesh);

}  // namespace hilcam
