#pragma once
// Puts a mesh's triangles in an order in which neighbours in space are neighbours in memory.

#include "render/vocabulary/mesh.h"

namespace hilcam {

// Along the Z-order curve (Morton, IBM technical report, 1966) of the triangles' centres, 10 bits an axis.
// Loads of a picture's hits then share cache lines, and runs of triangles have small bounding boxes.
void order_triangles(Mesh& mesh);

}  // namespace hilcam
