#pragma once
// Cuts triangles along the borders in a picture that covers them, so that each piece has one kind: an open
// part of a mask becomes a hole in the mesh, and a part that a texture calls metal becomes a surface of its
// own. Rays, shadows and cached light then need not know such pictures.

#include <cstdint>
#include <span>
#include <vector>

#include "io/meshes/kind_picture.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

struct SurfaceCut {
    static constexpr std::int32_t kNothing = -1;
    std::uint16_t surface = 0;                  // surface of the mesh to cut, by its texture coordinates
    std::vector<std::int32_t> surface_of_kind;  // or kNothing
    KindSource source;
    std::vector<LookKind> kinds;
};

// Cuts the triangles of these surfaces into at most max_more additional ones. When the borders would make
// more, the pictures are coarsened until they do not. Returns how often they were halved.
int cut_surfaces(Mesh& mesh, std::span<const SurfaceCut> cuts, std::size_t max_more);
// Cuts within the limits for a mesh file's pictures.
int cut_mesh(Mesh& mesh, std::span<const SurfaceCut> cuts);

}  // namespace hilcam
