#pragma once
// Finds the triangles of a mesh that a pixel may take for one, as they go on in one plane: the cells of a solar panel, the
// two halves of a quadrangle. One of them, the largest, stands for all: light meets its plane wherever the others are.
//
// Triangles of a group have the same surface and face the same way, they have one normal (no texture, colours, parameters of
// their own, or wrinkles that a level has flattened), and their corners lie in the largest one's plane but for the rounding of
// single precision. They are looked for among neighbours in memory (triangle_order.h), so that groups end here and there where
// the plane goes on.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "render/vocabulary/mesh.h"

namespace hilcam {

class CoverageMap;
struct ObjectSurfaces;

// Corners of a group lie no farther from the first corner of what stands for it than so many of its edges.
inline constexpr float kCoplanarReach = 64;

// This stands in ObjectSurfaces::coplanar_groups where the camera sees a triangle as part of what lies below it (coverage_map.h).
inline constexpr std::uint32_t kNotShown = ~std::uint32_t{0};

// Writes ObjectSurfaces::coplanar_groups and the marks of those that stand for others, after the normals of a level. The same for
// any number of threads. mesh: that of which the surfaces were made. Owner thread; some tenths of a second for a million
// triangles.
void find_coplanar_groups(const Mesh& mesh, ObjectSurfaces& surfaces);

// By triangle, 1 where a coverage map may have it (coverage_map_finder.h). Owner thread.
std::vector<std::uint8_t> may_be_in_coverage_maps(const Mesh& mesh, const ObjectSurfaces& surfaces);
// In a level of detail, the ground's largest triangle stands for all of a coverage map where its texels are at most four times as
// coarse as the level's error, and what lies on the ground is not shown by itself. After find_coplanar_groups(). Owner thread.
void attach_coverage_maps(const std::shared_ptr<const std::vector<CoverageMap>>& coverage_maps,
                          const Mesh& mesh, double error_m, ObjectSurfaces& surfaces);

}  // namespace hilcam
