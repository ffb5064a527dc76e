#include "render/lod/lod_normals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/lod/closest_triangle.h"
#include "render/lod/mesh_lod.h"
#include "render/vocabulary/units.h"
#include "tests/support/wavy_plate.h"

namespace hilcam {
namespace {

Mesh plate(int steps, double amplitude_m) { return wavy_plate(steps, 0, 1, amplitude_m); }

struct Look {
    Vec3d view, sun;
};

// What a white plate sends, whose parts do not hide each other: the sum of (n.v)+ (n.s)+ over area.
double light_of(const Mesh& mesh, Look look) {
    double sum = 0;
    for (const auto& triangle : mesh.triangles) {
        const Vec3d area = area_vector(mesh, triangle);
        const Vec3d n = normalized(area);
        sum += std::max(0.0, dot(area, look.view)) * std::max(0.0, dot(n, look.sun));
    }
    return sum;
}
// The same of a level, as a pixel shades it: all of a triangle's projected area, shared among its facets.
double light_of(const Mesh& level, const std::vector<LodNormals>& normals, Look look) {
    double sum = 0;
    for (std::size_t t = 0; t < level.triangles.size(); ++t) {
        const Vec3d area = area_vector(level, level.triangles[t]);
        const Vec3d flat = normalized(area);
        const LodNormals::Leans lean = normals[t].leans();
        const LodNormals::Floats share = normals[t].shares();
        double seen = 0, lit = 0;
        for (std::size_t i = 0; i < LodNormals::kMax; ++i) {
            const Vec3d n = normalized(flat + to_double({lean.x[i], lean.y[i], lean.z[i]}));
            const double each = static_cast<double>(share[i]) * std::max(0.0, dot(n, look.view));
            seen += each;
            lit += each * std::max(0.0, dot(n, look.sun));
        }
        if (seen > 0) sum += std::max(0.0, dot(area, look.view)) * lit / seen;
    }
    return sum;
}

Vec3d towards(double zenith_deg, double azimuth_deg) {
    const double z = zenith_deg * kDegree_rad, a = azimuth_deg * kDegree_rad;
    return {std::sin(z) * std::cos(a), std::sin(z) * std::sin(a), std::cos(z)};
}

TEST(LodNormals, AWrinkledPlateKeepsItsLightAsTwoTriangles) {
    const Mesh wrinkled = plate(400, 3e-3), flat = plate(1, 0);
    const std::vector<LodNormals> normals = lod_normals_of(wrinkled, flat, 6e-3);
    ASSERT_EQ(normals.size(), 2u);
    for (const double zenith : {0.0, 30.0, 60.0})
        for (const double azimuth : {0.0, 50.0, 110.0}) {
            const Look look{towards(20, 10), towards(zenith, azimuth)};
            EXPECT_NEAR(light_of(flat, normals, look) / light_of(wrinkled, look), 1, 0.01)
                << zenith << " " << azimuth;
        }
    // The Sun below the plate's own horizon lights only what leans towards it.
    const Look behind{towards(60, 180), towards(93, 0)};
    EXPECT_EQ(light_of(flat, std::vector(2, LodNormals::flat()), behind), 0);
    EXPECT_NEAR(light_of(flat, normals, behind) / light_of(wrinkled, behind), 1, 0.15);
}

TEST(LodNormals, WhatIsFlatStaysFlat) {
    const Mesh fine = plate(50, 0), coarse = plate(1, 0);
    for (const LodNormals& f : lod_normals_of(fine, coarse, 1e-3)) EXPECT_TRUE(f.is_flat());
}

TEST(LodNormals, TheOtherSideOfASheetIsNotItsOwn) {
    // Two plates back to back, nearer than the level's error; one of them wrinkled.
    Mesh sheet = plate(100, 3e-3), level = plate(1, 0);
    for (Mesh* mesh : {&sheet, &level}) {
        const auto first = static_cast<std::uint32_t>(mesh->vertices_m.size());
        const Mesh back = plate(1, 0);
        for (const Vec3f& v : back.vertices_m) mesh->vertices_m.push_back(v - Vec3f{0, 0, 1e-4f});
        for (const auto& t : back.triangles)
            mesh->triangles.push_back({first + t[0], first + t[2], first + t[1]});
        mesh->surface_of_triangle.assign(mesh->triangles.size(), 0);
    }
    const std::vector<LodNormals> normals = lod_normals_of(sheet, level, 1e-2);
    ASSERT_EQ(normals.size(), 4u);
    EXPECT_FALSE(normals[0].is_flat());
    EXPECT_FALSE(normals[1].is_flat());
    EXPECT_TRUE(normals[2].is_flat());
    EXPECT_TRUE(normals[3].is_flat());
}

TEST(LodNormals, LeansKeepFourDigitsAndSharesTwo) {
    const LodNormals f = LodNormals::of({{{{0.25f, -1.5f, 2}, 0.75f}, {{-2, 0, 1e-3f}, 0.25f}}}, 0.125f);
    EXPECT_NEAR(f.leans().x[0], 0.25f, 1e-4f);
    EXPECT_NEAR(f.leans().y[0], -1.5f, 1e-4f);
    EXPECT_NEAR(f.leans().z[0], 2, 1e-4f);
    EXPECT_NEAR(f.leans().x[1], -2, 1e-4f);
    EXPECT_NEAR(f.shares()[0], 0.75f, 2e-3f);
    EXPECT_NEAR(f.shares()[1], 0.25f, 2e-3f);
    EXPECT_EQ(f.alpha(), 0.125f);
    EXPECT_EQ(f.shares()[2], 0);
}

TEST(LodNormals, EveryLevelHasThemForEachTriangle) {
    const std::vector<MeshLevel> levels = coarser_levels(plate(200, 1e-3));
    ASSERT_GE(levels.size(), 3u);
    for (const MeshLevel& level : levels) EXPECT_EQ(level.lod_normals.size(), level.mesh.triangles.size());
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
