#pragma once
// Finds the mosaics (mosaic.h) of an object's mesh, and what of it they stand for.
//
// The ground is a flat part of one surface, as large as goes on from one of the largest triangles by common corners; upon it lie
// flat triangles of up to two other surfaces that lean as it does and are less than a texel above it. What has a picture, colours
// of its own, wrinkles that a level has flattened, mirrors, or lets light through is none of these: may_be is 0 for it, by triangle.

#include <cstdint>
#include <span>
#include <vector>

#include "render/lod/mosaic.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

// mesh: a level of detail; error_m: its error, and texels are no finer. Owner thread.
std::vector<Mosaic> find_mosaics(const Mesh& mesh, std::span<const std::uint8_t> may_be, double error_m);

// The triangles of a mosaic, each kind the largest first.
struct MosaicParts {
    std::vector<std::uint32_t> ground, upon;
};
// By mosaic, in another level of detail. Owner thread.
std::vector<MosaicParts> mosaic_parts(std::span<const Mosaic> mosaics, const Mesh& mesh,
                                      std::span<const std::uint8_t> may_be);

}  // namespace hilcam
