#pragma once
// Levels of detail kept on disk: making them takes seconds per million triangles.

#include <vector>

#include "io/cache/cache.h"
#include "render/lod/mesh_lod.h"

namespace hilcam {

// The mesh's levels from the cache, made and written there if need be. A file that is damaged, or not this
// mesh's, is made anew; a folder that cannot be written is no failure.
std::vector<MeshLevel> cached_levels(const Mesh& mesh, const Cache& cache);

}  // namespace hilcam
