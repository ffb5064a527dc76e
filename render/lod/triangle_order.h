#pragma once
// Puts a mesh's triangles in an order in which neighbours in space are neighbours in memory.

#include <cstdint>
#include <vector>

#include "render/vocabulary/mesh.h"

namespace hilcam {

// Along the Z-order curve (Morton, IBM technical report, 1966) of the triangles' centres, 10 bits an axis.
// Loads of a picture's hits then share cache lines, and runs of triangles have small bounding boxes.
// Returns where each was before.
std::vector<std::uint32_t> order_triangles(Mesh& mesh);

}  // namespace hilcam
