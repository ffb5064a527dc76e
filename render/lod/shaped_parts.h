#pragma once
// Says which parts of a mesh are shaped, as masts, rings, dishes and boxes are: bent to one side more than to the other.
// What is wrinkled, as crumpled foil, is bent to both alike. A level of detail may flatten wrinkles, whose light it keeps
// by how they leaned (lod_normals.h), but not shapes: of a mast that is some of its own radius off in places, or of a
// ring seen from its edge, the thin sunlit part has other light.
//
// A part is what of one surface hangs together by edges of two triangles. How it is bent is measured by the mean
// curvature over its edges, half of each one's length times its angle, above zero where it is convex (Cohen-Steiner &
// Morvan, SoCG 2003, section 3): shaped is a part whose sum of these is half of the sum of their sizes or more.

#include <vector>

#include "render/vocabulary/mesh.h"

namespace hilcam {

// One for each triangle. Flat parts are not shaped: they have nothing to lose. Owner thread; half a second per million triangles.
std::vector<bool> find_shaped(const Mesh& mesh);

}  // namespace hilcam
