#pragma once
// Sorts a mesh's triangles so that neighbours in space are neighbours in memory.

#include <cstdint>
#include <vector>

#include "render/vocabulary/mesh.h"

namespace hilcam {

// Sorts along the Z-order curve (Morton, IBM technical report, 1966) of the triangles' centres, 10 bits per
// axis. The hits of a picture then share cache lines, and runs of triangles have small bounding boxes.
// Returns the old position of each triangle.
std::vector<std::uint32_t> order_triangles(Mesh& mesh);

}  // namespace hilcam
