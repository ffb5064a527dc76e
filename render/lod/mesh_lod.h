#pragma once
// Levels of detail: coarser copies of a mesh, each within a known distance of it, made once by edge collapse
// (meshoptimizer; quadric error of Garland & Heckbert, SIGGRAPH 97).
//
// Surfaces are simplified one by one and their borders stay, so that materials keep their areas: a level
// never loses a solar cell, it only has no needless triangles in it. How the wrinkles leaned that a level has
// flattened is kept triangle by triangle, for what the camera sees (lod_normals.h), and as roughness of a
// whole surface, for everything else.

#include <vector>

#include "render/lod/lod_normals.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

struct MeshLevel {
    Mesh mesh;           // textures left empty: they are the first level's. Triangles are in order
    double error_m = 0;  // no point of the mesh is farther from the level, about
    // Per surface: GGX alpha of the normals that the level has flattened; adds to a material's by squares.
    std::vector<float> flattened_alpha;
    std::vector<LodNormals> lod_normals;  // by triangle
};

// Makes the levels from fine to coarse, error growing twofold; a level is kept where it saves two fifths of
// the triangles. Empty for small meshes. Owner thread; some seconds per million triangles.
std::vector<MeshLevel> coarser_levels(const Mesh& mesh);

}  // namespace hilcam
