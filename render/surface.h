#pragma once
// What shading needs of a mesh, packed so that a hit touches one cache line: per triangle three normals and a
// surface.

#include <array>
#include <cstdint>
#include <vector>

#include "render/scene.h"

namespace hilcam {

// Unit vectors in 32 bits, octahedral with 16 bits an axis: largest error 0.0037 deg (Cigolle et al., JCGT
// 3(2), 2014).
std::uint32_t pack_normal(Vec3f unit);
Vec3f unpack_normal(std::uint32_t packed);

struct PackedTriangle {
    std::array<std::uint32_t, 3> corner_normals;  // meaningless when flat
    std::uint16_t surface;
    std::uint16_t flat;  // 1: the mesh has no normals; use the geometric one
};
static_assert(sizeof(PackedTriangle) == 16);

// An object as rays see it.
struct ObjectSurfaces {
    explicit ObjectSurfaces(SceneObject&& object);

    std::vector<PackedTriangle> triangles;
    std::vector<std::array<Vec2f, 3>> corner_uvs;  // empty when no material has a texture
    std::vector<Material> materials;
    std::vector<Texture> textures;
    // Least and greatest corner of runs of triangles, body axes: together they cover the object closely.
    std::vector<std::array<Vec3f, 2>> cluster_bounds_m;

    // The shading normal at barycentric (u, v), body axes, unit; `geometric` where the mesh has none.
    Vec3f normal_at(const PackedTriangle& triangle, float u, float v, Vec3f geometric) const;
};

}  // namespace hilcam
