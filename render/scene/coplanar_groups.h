#pragma once
// Finds triangles of a mesh that continue each other in one plane, such as the cells of a solar panel or the
// two halves of a quadrangle. A pixel then treats the group as one triangle: the largest one represents the
// others, and its plane is used wherever they are hit.
//
// All triangles of a group have the same surface, side and single normal (no texture, no colours or
// parameters of their own, no wrinkles flattened by a level). Their corners are in the largest one's plane up
// to single-precision rounding. Only neighbours in memory are compared (triangle_order.h), so some groups end
// although the plane continues.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "render/vocabulary/mesh.h"

namespace hilcam {

class CoverageMap;
struct ObjectSurfaces;

// The corners of a group are at most this many edge lengths of its largest triangle away from that triangle's
// first corner.
inline constexpr float kCoplanarReach = 64;

// The value of ObjectSurfaces::coplanar_groups for a triangle that the camera sees as part of the coverage
// map below it (coverage_map.h).
inline constexpr std::uint32_t kNotShown = ~std::uint32_t{0};

// Fills ObjectSurfaces::coplanar_groups and marks the triangles that represent others; call it after the
// normals of a level are made. The result does not depend on the number of threads. mesh: the one from which
// the surfaces were made. Owner thread; takes some tenths of a second for a million triangles.
void find_coplanar_groups(const Mesh& mesh, ObjectSurfaces& surfaces);

// Returns 1 for each triangle that may become part of a coverage map (coverage_map_finder.h). Owner thread.
std::vector<std::uint8_t> may_be_in_coverage_maps(const Mesh& mesh, const ObjectSurfaces& surfaces);
// Attaches coverage maps to a level of detail. The largest triangle of the map's ground represents the whole
// map, if the map's texels are at most four times as coarse as the level's error; triangles on the ground are
// then not shown themselves. Call it after find_coplanar_groups(). Owner thread.
void attach_coverage_maps(const std::shared_ptr<const std::vector<CoverageMap>>& coverage_maps,
                          const Mesh& mesh, double error_m, ObjectSurfaces& surfaces);

}  // namespace hilcam
