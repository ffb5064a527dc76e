#include "render/levels/level_facets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/levels/closest_triangle.h"
#include "tests/support/wavy_plate.h"

namespace hilcam {
namespace {

Mesh plate(int steps, double amplitude_m) { return wavy_plate(steps, 0, 1, amplitude_m); }

TEST(LevelFacets, LeansKeepFourDigitsAndSharesTwo) {
    const LevelFacets f = LevelFacets::of({{{{0.25f, -1.5f, 2}, 0.75f}, {{-2, 0, 1e-3f}, 0.25f}}}, 0.125f);
    EXPECT_NEAR(f.leans().x[0], 0.25f, 1e-4f);
    EXPECT_NEAR(f.leans().y[0], -1.5f, 1e-4f);
    EXPECT_NEAR(f.leans().z[0], 2, 1e-4f);
    EXPECT_NEAR(f.leans().x[1], -2, 1e-4f);
    EXPECT_NEAR(f.shares()[0], 0.75f, 2e-3f);
    EXPECT_NEAR(f.shares()[1], 0.25f, 2e-3f);
    EXPECT_EQ(f.alpha(), 0.125f);
    EXPECT_EQ(f.shares()[2], 0);
}

// Against looking at all of them.
TEST(ClosestTriangle, IsTheNearestOfItsSurfaceThatFacesTheSameWay) {
    Mesh mesh = plate(12, 2e-2);
    mesh.surfaces.resize(2);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) mesh.surface_of_triangle[t] = t % 3 == 0;
    const ClosestTriangle closest(mesh);
    for (int i = 0; i < 200; ++i) {
        const auto part = [&](double step) { return static_cast<float>(std::fmod(step * i, 1.0)); };
        const Vec3f place{part(0.618), part(0.414), part(0.732) * 0.1f - 0.05f};
        const auto surface = static_cast<std::uint16_t>(i % 2);
        const auto found = closest.find({place, {0, 0, 1}, surface, 1});
        ASSERT_TRUE(found);
        EXPECT_EQ(mesh.surface_of_triangle[found->triangle], surface);
        const auto at = [&](std::uint32_t t, float u, float v) {
            const auto& c = mesh.triangles[t];
            return (1 - u - v) * mesh.vertices_m[c[0]] + u * mesh.vertices_m[c[1]] +
                   v * mesh.vertices_m[c[2]];
        };
        const float distance = length(at(found->triangle, found->u, found->v) - place);
        float least = 1e30f;
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            if (mesh.surface_of_triangle[t] != surface) continue;
            constexpr int kSteps = 40;
            for (int a = 0; a <= kSteps; ++a)
                for (int b = 0; a + b <= kSteps; ++b)
                    least = std::min(
                        least, length(at(t, static_cast<float>(a) / kSteps, static_cast<float>(b) / kSteps) -
                                      place));
        }
        EXPECT_LE(distance, least + 1e-6f);
        EXPECT_GE(distance, least - 4e-3f);  // the steps' own distance
    }
    EXPECT_FALSE(closest.find({{0.5f, 0.5f, 0}, {0, 0, -1}, 0, 1}));
    EXPECT_FALSE(closest.find({{0.5f, 0.5f, 9}, {0, 0, 1}, 0, 1}));
}

// Whatever the tree looks like.
TEST(ClosestTriangle, OfEquallyNearOnesItIsTheFirst) {
    Mesh mesh = plate(12, 2e-2);
    const std::size_t count = mesh.triangles.size();
    for (std::size_t t = 0; t < count; ++t) mesh.triangles.push_back(mesh.triangles[count - 1 - t]);
    mesh.surface_of_triangle.assign(mesh.triangles.size(), 0);
    const ClosestTriangle closest(mesh);
    for (std::size_t t = 0; t < count; t += 7) {
        const auto& c = mesh.triangles[t];
        const Vec3f middle = (mesh.vertices_m[c[0]] + mesh.vertices_m[c[1]] + mesh.vertices_m[c[2]]) / 3.0f;
        EXPECT_EQ(closest.find({middle, {0, 0, 1}, 0, 1})->triangle, t);
    }
}

}  // namespace
}  // namespace hilcam
