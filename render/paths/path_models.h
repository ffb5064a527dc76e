#pragma once
// The program's own path models (see path_model.h).

#include <array>
#include <memory>
#include <span>

#include "render/shading/path_model.h"

namespace hilcam {

std::unique_ptr<PathModel> make_direct_paths();
std::unique_ptr<PathModel> make_hemisphere_paths();
std::unique_ptr<PathModel> make_kept_paths();
std::unique_ptr<PathModel> make_traced_paths();

// The 60 directions of `hemisphere`, about +z: the middles of the equal triangles that a dodecahedron's
// faces, cut at their planes of symmetry, make of the half sphere above one of those planes. Unit vectors.
std::span<const Vec3f, 60> hemisphere_directions();

}  // namespace hilcam
