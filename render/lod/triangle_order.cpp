#include "render/lod/triangle_order.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>

namespace hilcam {
namespace {

// Spreads 10 bits, with two zeros after each.
std::uint32_t spread(std::uint32_t x) {
    x = (x | (x << 16)) & 0x030000FFu;
    x = (x | (x << 8)) & 0x0300F00Fu;
    x = (x | (x << 4)) & 0x030C30C3u;
    return (x | (x << 2)) & 0x09249249u;
}

}  // namespace

std::vector<std::uint32_t> order_triangles(Mesh& mesh) {
    const auto center = [&](const std::array<std::uint32_t, 3>& t) {
        return (mesh.vertices_m[t[0]] + mesh.vertices_m[t[1]] + mesh.vertices_m[t[2]]) / 3.0f;
    };
    Vec3f least{INFINITY, INFINITY, INFINITY}, most{-INFINITY, -INFINITY, -INFINITY};
    for (const auto& triangle : mesh.triangles) {
        const Vec3f c = center(triangle);
        least = {std::min(least.x, c.x), std::min(least.y, c.y), std::min(least.z, c.z)};
        most = {std::max(most.x, c.x), std::max(most.y, c.y), std::max(most.z, c.z)};
    }
    const Vec3f size = most - least;
    const float scale = 1023.0f / std::max({size.x, size.y, size.z, 1e-30f});
    const auto cell = [&](float value) {
        return static_cast<std::uint32_t>(std::clamp(value, 0.0f, 1023.0f));
    };

    // Key and old place in one word: equal keys keep their order, whatever the number of threads.
    std::vector<std::uint64_t> order(mesh.triangles.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Vec3f c = scale * (center(mesh.triangles[i]) - least);
        const std::uint64_t key = spread(cell(c.x)) | spread(cell(c.y)) << 1 | spread(cell(c.z)) << 2;
        order[i] = key << 32 | i;
    }
    tbb::parallel_sort(order.begin(), order.end());
    std::vector<std::array<std::uint32_t, 3>> triangles(order.size());
    std::vector<std::uint16_t> surfaces(order.size());
    std::vector<std::uint32_t> before(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        before[i] = static_cast<std::uint32_t>(order[i]);
        triangles[i] = mesh.triangles[before[i]];
        surfaces[i] = mesh.surface_of_triangle[before[i]];
    }
    mesh.triangles = std::move(triangles);
    mesh.surface_of_triangle = std::move(surfaces);
    return before;
}

}  // namespace hilcam
