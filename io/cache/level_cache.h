#pragma once
// Keeps levels of detail on disk, because making them takes seconds per million triangles.

#include <vector>

#include "io/cache/cache.h"
#include "render/lod/mesh_lod.h"

namespace hilcam {

// Returns the mesh's levels from the cache; makes and keeps them when they are missing, damaged, or another
// mesh's. A folder that cannot be written is no error.
std::vector<MeshLevel> cached_levels(const Mesh& mesh, const Cache& cache);

}  // namespace hilcam
