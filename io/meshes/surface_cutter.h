#pragma once
// Cuts triangles along the borders of a picture that lies on them, so that each part is of one kind: what a mask leaves open becomes a hole in
// the mesh, and what a texture says to be metal a surface of its own. Rays, shadows and cached light then need to know nothing of
// such pictures.

#include <cstdint>
#include <span>
#include <vector>

#include "io/meshes/kind_picture.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

struct SurfaceCut {
    static constexpr std::int32_t kNothing = -1;
    std::uint16_t surface = 0;                  // surface of the mesh that is cut, by its uvs
    std::vector<std::int32_t> surface_of_kind;  // or kNothing
    KindSource source;
    std::vector<LookKind> kinds;
};

// Cuts the triangles of these surfaces into at most so many more than there are; where the pictures' borders would make more, they are taken
// coarser until they do not. Returns how often they were halved.
int cut_surfaces(Mesh& mesh, std::span<const SurfaceCut> cuts, std::size_t max_more);
// Does so within what a mesh file's pictures may cost.
int cut_mesh(Mesh& mesh, std::span<const SurfaceCut> cuts);

}  // namespace hilcam
