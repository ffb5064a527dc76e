#include "render/lod/triangle_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace hilcam {
namespace {

TEST(TriangleOrder, KeepsTheTrianglesAndTheirSurfaces) {
    std::mt19937 engine(3);
    std::uniform_real_distribution<float> uniform(-5, 5);
    Mesh mesh;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const Vec3f at{uniform(engine), uniform(engine), uniform(engine)};
        mesh.vertices_m.insert(mesh.vertices_m.end(), {at, at + Vec3f{0.1f, 0, 0}, at + Vec3f{0, 0.1f, 0}});
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        mesh.surface_of_triangle.push_back(static_cast<std::uint16_t>(i));
    }
    const auto path_m = [&] {
        double sum = 0;
        for (std::size_t i = 1; i < mesh.triangles.size(); ++i)
            sum += static_cast<double>(
                length(mesh.vertices_m[mesh.triangles[i][0]] - mesh.vertices_m[mesh.triangles[i - 1][0]]));
        return sum;
    };
    const double before = path_m();
    order_triangles(mesh);
    std::vector<bool> seen(1000);
    for (std::size_t i = 0; i < 1000; ++i) {
        EXPECT_EQ(mesh.triangles[i][0], 3u * mesh.surface_of_triangle[i]);
        seen[mesh.surface_of_triangle[i]] = true;
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), true), 1000);
    EXPECT_LT(path_m(), 0.3 * before);
}

}  // namespace
}  // namespace hilcam
