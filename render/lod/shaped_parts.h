#pragma once
// Finds the shaped parts of a mesh, such as masts, rings, dishes and boxes: they bend more to one side than
// to the other. Wrinkles, as in crumpled foil, bend equally to both. A level of detail may flatten wrinkles,
// whose normals it keeps (lod_normals.h), but not shapes: if a mast is off by part of its radius, or a ring
// is seen edge-on, the thin sunlit part has other light.
//
// A part is a piece of one surface, connected by edges of two triangles. Its bending is measured by the mean
// curvature over its edges: half of each edge's length times its angle, positive if convex (Cohen-Steiner &
// Morvan, SoCG 2003, section 3). A part is shaped if the sum of these is at least half of the sum of their
// absolute values.

#include <vector>

#include "render/vocabulary/mesh.h"

namespace hilcam {

// Returns one flag for each triangle. Flat parts are not shaped, because they have nothing to lose. Owner
// thread; half a second per million triangles.
std::vector<bool> find_shaped(const Mesh& mesh);

}  // namespace hilcam
