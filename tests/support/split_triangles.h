#pragma once
// Cuts each triangle of a mesh in four at the middles of its edges, so many times. Neighbours have no new corner in
// common; surfaces are left to the caller.

#include <array>
#include <cstdint>
#include <vector>

#include "render/vocabulary/mesh.h"

namespace hilcam {

inline void split_triangles(Mesh& mesh, int times) {
    for (int round = 0; round < times; ++round) {
        std::vector<std::array<std::uint32_t, 3>> parts;
        for (const auto& [a, b, c] : mesh.triangles) {
            const auto middle = [&](std::uint32_t i, std::uint32_t k) {
                mesh.vertices_m.push_back(0.5f * (mesh.vertices_m[i] + mesh.vertices_m[k]));
                return static_cast<std::uint32_t>(mesh.vertices_m.size() - 1);
            };
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            for (const std::array<std::uint32_t, 3>& part :
                 {std::array<std::uint32_t, 3>{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
                parts.push_back(part);
        }
        mesh.triangles = parts;
    }
}

}  // namespace hilcam
