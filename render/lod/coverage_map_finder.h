#pragma once
// Finds the coverage maps (coverage_map.h) of an object's mesh, and the triangles that they represent.
//
// The ground is a flat part of one surface: everything connected by common corners to one of the largest
// triangles. On top are flat triangles of up to two other surfaces, parallel to it and less than a texel
// above it. Triangles with a texture, colours, flattened wrinkles, mirrors or transparency are excluded:
// may_be is 0 for them.

#include <cstdint>
#include <span>
#include <vector>

#include "render/lod/coverage_map.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

// mesh: a level of detail. error_m: its error; texels are not finer than that. Owner thread.
std::vector<CoverageMap> find_coverage_maps(const Mesh& mesh, std::span<const std::uint8_t> may_be,
                                            double error_m);

// The triangles of a coverage map; in each list the largest is first.
struct CoverageMapParts {
    std::vector<std::uint32_t> ground, upon;
};
// Returns them for each coverage map, in another level of detail. Owner thread.
std::vector<CoverageMapParts> coverage_map_parts(std::span<const CoverageMap> coverage_maps, const Mesh& mesh,
                                                 std::span<const std::uint8_t> may_be);

}  // namespace hilcam
