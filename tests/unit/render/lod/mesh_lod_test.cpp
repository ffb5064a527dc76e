#include "render/lod/mesh_lod.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Two cones on one rim, with so many triangles at each tip: a finer rim than any level needs.
Mesh spindle(std::uint32_t count) {
    Mesh mesh;
    mesh.surfaces.resize(1);
    mesh.vertices_m = {{0, 0, 1}, {0, 0, -1}};
    for (std::uint32_t i = 0; i < count; ++i) {
        const double angle = 2 * kPi * i / count;
        mesh.vertices_m.push_back(to_float({std::cos(angle), std::sin(angle), 0}));
        const std::uint32_t here = 2 + i, next = 2 + (i + 1) % count;
        mesh.triangles.push_back({0, here, next});
        mesh.triangles.push_back({1, next, here});
    }
    mesh.surface_of_triangle.assign(mesh.triangles.size(), 0);
    return mesh;
}

// What would take the library squares of that many steps (a minute of this one) is drawn as it is.
TEST(MeshLevels, AVertexWithAHundredThousandTrianglesHasNone) {
    EXPECT_FALSE(coarser_levels(spindle(2000)).empty());
    EXPECT_TRUE(coarser_levels(spindle(100'000)).empty());
    // Corners of their own in the same places, as files without shared vertices have them.
    Mesh same;
    same.surfaces.resize(1);
    for (std::uint32_t i = 0; i < 100'000; ++i) {
        same.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        same.vertices_m.insert(same.vertices_m.end(), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    }
    same.surface_of_triangle.assign(same.triangles.size(), 0);
    EXPECT_TRUE(coarser_levels(same).empty());
}

}  // namespace
}  // namespace hilcam
