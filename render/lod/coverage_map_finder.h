#pragma once
// Finds the coverage maps (coverage_map.h) of an object's mesh, and what of it they stand for.
//
// The ground is a flat part of one surface, as large as goes on from one of the largest triangles by common corners; upon it lie
// flat triangles of up to two other surfaces that lean as it does and are less than a texel above it. What has a picture, colours
// of its own, wrinkles that a level has flattened, mirrors, or lets light through is none of these: may_be is 0 for it, by triangle.

#include <cstdint>
#include <span>
#include <vector>

#include "render/lod/coverage_map.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

// mesh: a level of detail; error_m: its error, and texels are no finer. Owner thread.
std::vector<CoverageMap> find_coverage_maps(const Mesh& mesh, std::span<const std::uint8_t> may_be,
                                            double error_m);

// The triangles of a coverage map, each kind the largest first.
struct CoverageMapParts {
    std::vector<std::uint32_t> ground, upon;
};
// By coverage map, in another level of detail. Owner thread.
std::vector<CoverageMapParts> coverage_map_parts(std::span<const CoverageMap> coverage_maps, const Mesh& mesh,
                                                 std::span<const std::uint8_t> may_be);

}  // namespace hilcam
