#include "render/scene/mesh_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "render/scene/embree_scene.h"

namespace hilcam {
namespace {

// Hills with a skirt around them, as grids of several sizes side by side.
struct Hills {
    Mesh mesh;
    std::vector<MeshGrid> grids;

    Hills() {
        float left_m = 0;
        for (const std::uint32_t quads : {7u, 32u}) {
            const MeshGrid grid{static_cast<std::uint32_t>(mesh.vertices_m.size()),
                                static_cast<std::uint32_t>(mesh.triangles.size()), quads};
            grids.push_back(grid);
            const auto side = static_cast<int>(MeshGrid::side(quads));
            for (int y = 0; y < side; ++y)
                for (int x = 0; x < side; ++x) {
                    const auto fx = static_cast<float>(std::clamp(x, 1, side - 2)),
                               fy = static_cast<float>(std::clamp(y, 1, side - 2));
                    const bool below = x == 0 || y == 0 || x == side - 1 || y == side - 1;
                    mesh.vertices_m.push_back(
                        {left_m + fx, fy, std::sin(0.9f * fx) * std::cos(0.7f * fy) - (below ? 2.0f : 0.0f)});
                }
            mesh.triangles.resize(grid.first_triangle + MeshGrid::triangles(quads));
            grid.for_each_quad([&](std::uint32_t triangle, std::uint32_t corner) {
                const auto step = static_cast<std::uint32_t>(side);
                mesh.triangles[triangle] = {corner, corner + 1, corner + step};
                mesh.triangles[triangle + 1] = {corner + 1, corner + step + 1, corner + step};
            });
            left_m += static_cast<float>(quads) + 3;
        }
    }
};

// All triangles of a grid are numbered once, those within the skirt row by row.
TEST(MeshGrid, NumbersItsTriangles) {
    const MeshGrid grid{100, 40, 5};
    std::set<std::uint32_t> triangles;
    grid.for_each_quad([&](std::uint32_t triangle, std::uint32_t corner) {
        EXPECT_TRUE(triangles.insert(triangle).second) << triangle;
        EXPECT_LT(corner, 100 + MeshGrid::vertices(5));
    });
    EXPECT_EQ(2 * triangles.size(), MeshGrid::triangles(5));
    EXPECT_EQ(*triangles.begin(), 40u);
    EXPECT_EQ(*triangles.rbegin(), 40 + MeshGrid::triangles(5) - 2);
    for (std::uint32_t y = 0; y < 5; ++y)
        for (std::uint32_t x = 0; x < 5; ++x) EXPECT_EQ(grid.quad_at(x + 1, y + 1), 5 * y + x);
}

// Rays meet a tree of grids where they meet that of its triangles, and are told the same triangle, place and normal.
TEST(MeshGrid, RaysMeetWhatTheyMeetOfItsTriangles) {
    const Hills hills;
    Mesh first;
    first.vertices_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    first.triangles = {{0, 1, 2}};
    EmbreeScene scene(std::vector<std::vector<const Mesh*>>{{&first}, {&first}}, true);
    PreparedMesh of_triangles = scene.prepare(hills.mesh), of_grids = scene.prepare(hills.mesh, hills.grids);
    scene.adopt(0, of_triangles), scene.adopt(1, of_grids);
    int met = 0, others = 0;
    for (int i = 0; i < 20'000; ++i) {
        // Roberts' sequence (2018) over the hills, aslant by up to a half.
        const auto share = [&](double step) { return static_cast<float>(std::fmod(step * i, 1.0)); };
        const Vec3f from{-2 + 49 * share(0.8191725134), -2 + 39 * share(0.6710436067), 10};
        const Vec3f dir{share(0.5497004779) - 0.5f, share(0.4503) - 0.5f, -1};
        RayPacket rays;
        rays.count = 1;
        rays.set(0, from, dir, 0, 100);
        HitPacket wanted, found;
        scene.intersect_with(0, rays, wanted), scene.intersect_with(1, rays, found);
        ASSERT_EQ(wanted.object[0] == HitPacket::kMiss, found.object[0] == HitPacket::kMiss) << i;
        if (found.object[0] == HitPacket::kMiss) continue;
        ++met;
        EXPECT_NEAR(found.distance[0], wanted.distance[0], 1e-4) << i;
        // On an edge either side is right.
        if (found.triangle[0] != wanted.triangle[0]) {
            ++others;
            continue;
        }
        EXPECT_NEAR(found.u[0], wanted.u[0], 5e-5) << i;
        EXPECT_NEAR(found.v[0], wanted.v[0], 5e-5) << i;
        const Vec3f a = normalized(Vec3f{found.normal_x[0], found.normal_y[0], found.normal_z[0]}),
                    b = normalized(Vec3f{wanted.normal_x[0], wanted.normal_y[0], wanted.normal_z[0]});
        EXPECT_GT(dot(a, b), 0.999999f) << i;
    }
    EXPECT_GT(met, 10'000);
    EXPECT_LT(others, 5);
}

}  // namespace
}  // namespace hilcam
