#pragma once
// Where the ground of a mesh of tiles (ground_normals.h) is surely lit by the Sun or surely in shadow: the Sun stands still while a
// mesh is shown, so one ray a vertex, beside the frames, saves most of those a pixel.

#include <cstdint>
#include <vector>

#include "render/scene/embree_scene.h"
#include "render/scene/terrain.h"

namespace hilcam {

// Traces a ray from each vertex of a mesh with tiles towards the Sun, sun_dir in terrain axes. A triangle is lit or dark where all
// vertices within a quadrilateral of its corners are; others, and those of a tile's skirts, are to be asked. A
// shadow that passes between vertices, narrower than a quadrilateral, is not seen. Any thread; allocates.
std::vector<KnownSun> known_sun(const EmbreeScene& embree, const PreparedMesh& tree,
                                const TerrainMesh& terrain, Vec3d sun_dir);

}  // namespace hilcam
