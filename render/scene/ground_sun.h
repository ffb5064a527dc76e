#pragma once
// Finds which parts of a ground mesh (ground_normals.h) are surely lit by the Sun or surely in shadow. The
// Sun stands still while a mesh is shown, so one test per vertex, made beside the frames, saves most of the
// tests per pixel.
//
// The ground is projected along the Sun's rays, where each vertex is a point and the triangles that shade it
// cover that point. A ray from the ground to the Sun can re-enter the ground only through triangles that face
// away from the Sun. These are few, and are tested exactly (an irregular z-buffer; Johnson, Lee, Burns and
// Mark, ACM Trans. Graphics 24(4), 1462, 2005).

#include <vector>

#include "render/scene/terrain.h"

namespace hilcam {

// Tests each vertex of a mesh with tiles; sun_dir in terrain axes. A triangle is lit or dark if all vertices
// within one quadrilateral of its corners are. Rays must ask for the others and for those of tile skirts.
// Shadows narrower than a quadrilateral can pass between vertices unnoticed. Any thread; allocates.
std::vector<SunVisibility> sun_visibility(const TerrainMesh& terrain, Vec3d sun_dir);

}  // namespace hilcam
