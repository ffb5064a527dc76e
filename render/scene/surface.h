#pragma once
// The data that shading needs of a mesh, packed so that a hit touches one cache line: three normals and a
// surface for each triangle.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "render/lod/lod_normals.h"
#include "render/scene/color_bands.h"
#include "render/scene/ground_normals.h"
#include "render/scene/packed_normal.h"
#include "render/scene/scene.h"

namespace hilcam {

class CoverageMap;

struct PackedTriangle {
    std::array<std::uint32_t, 3> corner_normals;  // undefined if flat
    std::uint16_t surface;
    std::uint8_t flat;  // 1: the mesh has no normals; use the geometric one
    // 1: it represents other triangles in its plane (coplanar_groups.h); 2 and more: it represents coverage
    // map number 0 and on (coverage_map.h).
    std::uint8_t coplanar_group;
};
static_assert(sizeof(PackedTriangle) == 16);

// Factors on a material's base: linear red, green, blue, each 0 to 4 in 16 bits.
using PackedColor = std::array<std::uint16_t, 3>;
inline constexpr float kColorSteps = 65535.0f / 4;

inline constexpr std::size_t kClusterTriangles = 256;

// Extends a box (least and greatest corner) to hold a point.
void grow(std::array<Vec3f, 2>& box_m, Vec3f to_m);

// An object as rays see it.
struct ObjectSurfaces {
    // materials: one for each surface of the mesh; a material's texture is an index into `textures`.
    ObjectSurfaces(const Mesh& mesh, std::vector<Material> materials,
                   std::shared_ptr<const std::vector<MipTexture>> textures);

    std::vector<PackedTriangle> triangles;
    std::vector<std::array<Vec2f, 3>> corner_uvs;  // empty if no material has a texture
    std::vector<float>
        uv_per_m;  // per triangle of a textured object: length in the picture per length on the surface
    std::vector<std::array<PackedColor, 3>> corner_colors;     // empty if the mesh has none
    std::vector<std::array<HapkeParameters, 3>> corner_hapke;  // empty if the mesh has none
    std::vector<Material> materials;
    // For each surface, the slopes that this level of detail has flattened, as a GGX alpha. The materials'
    // alphas already include them. Empty for the full mesh, which flattens nothing.
    std::vector<float> flattened_alpha;
    // Normals that a level's triangles represent; empty for the full mesh.
    std::vector<LodNormals> lod_normals;
    std::shared_ptr<const std::vector<MipTexture>> textures;  // shared by an object's levels of detail
    std::shared_ptr<const GroundNormals> ground_normals;      // null: only the corners' normals
    std::vector<SunVisibility> sun_visibility;                // per triangle; empty: rays have to ask
    // A box (least and greatest corner, body axes) around each kClusterTriangles triangles; together they fit
    // the object closely.
    std::vector<std::array<Vec3f, 2>> cluster_bounds_m;
    // For each triangle the one that represents it, or kNotShown; empty: each represents itself.
    std::vector<std::uint32_t> coplanar_groups;
    std::shared_ptr<const std::vector<CoverageMap>>
        coverage_maps;    // the maps that triangles represent; null: none
    double radius_m = 0;  // radius of a sphere about the body's origin that holds the object

    // Returns a lobe's alpha without the slopes that the level has flattened on a surface.
    float unflattened(std::uint16_t surface, float alpha) const {
        const float flattened = flattened_alpha.empty() ? 0.0f : flattened_alpha[surface];
        return flattened > 0 ? std::sqrt(std::max(0.0f, alpha * alpha - flattened * flattened)) : alpha;
    }
    // Returns the factor on the base at barycentric (u, v) of a triangle. Needs corner_colors.
    Vec3f color_at(std::size_t triangle, float u, float v) const {
        const auto& c = corner_colors[triangle];
        const auto at = [&](std::size_t k) {
            return ((1 - u - v) * static_cast<float>(c[0][k]) + u * static_cast<float>(c[1][k]) +
                    v * static_cast<float>(c[2][k])) /
                   kColorSteps;
        };
        return {at(0), at(1), at(2)};
    }
    // Returns the parameters of Hapke's law at this place. Needs corner_hapke.
    HapkeParameters hapke_at(std::size_t triangle, float u, float v) const {
        const auto& c = corner_hapke[triangle];
        return blend(c[0], 1 - u - v, c[1], u, c[2], v);
    }
    // Returns the shading normal at barycentric (u, v), body axes, unit; `geometric` if the mesh has no
    // normals.
    static Vec3f normal_at(const PackedTriangle& triangle, float u, float v, Vec3f geometric) {
        if (triangle.flat) return geometric;
        const Vec3f n = (1 - u - v) * unpack_normal(triangle.corner_normals[0]) +
                        u * unpack_normal(triangle.corner_normals[1]) +
                        v * unpack_normal(triangle.corner_normals[2]);
        const float squared = dot(n, n);
        // Opposite corner normals can cancel out.
        return squared > 1e-6f ? n / std::sqrt(squared) : geometric;
    }
};

}  // namespace hilcam
