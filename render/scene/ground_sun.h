#pragma once
// Where the ground of a mesh of tiles (ground_normals.h) is surely lit by the Sun or surely in shadow: the Sun stands still while a
// mesh is shown, so one question a vertex, beside the frames, saves most of those a pixel.
//
// Ground is seen as the Sun sees it: in a plane across its rays, where a vertex is a point and whatever shades it lies over it. A ray that leaves
// the ground can come back into it only where the ground faces away from the Sun, which little of it does: only those triangles are asked,
// and exactly (an irregular z-buffer; Johnson, Lee, Burns and Mark, ACM Trans. Graphics 24(4), 1462, 2005).

#include <vector>

#include "render/scene/terrain.h"

namespace hilcam {

// Asks the Sun from each vertex of a mesh with tiles, sun_dir in terrain axes. A triangle is lit or dark where all
// vertices within a quadrilateral of its corners are; others, and those of a tile's skirts, are to be asked. A
// shadow that passes between vertices, narrower than a quadrilateral, is not seen. Any thread; allocates.
std::vector<SunVisibility> sun_visibility(const TerrainMesh& terrain, Vec3d sun_dir);

}  // namespace hilcam
