#include "render/levels/facet_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "render/levels/mesh_lod.h"
#include "render/vocabulary/units.h"
#include "tests/support/wavy_plate.h"

namespace hilcam {
namespace {

Mesh square_metre(int steps, double amplitude_m) { return wavy_plate(steps, 0, 1, amplitude_m); }

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
double light_of(const Mesh& level, const FacetMap& map, Look look) {
    double sum = 0;
    for (std::size_t t = 0; t < level.triangles.size(); ++t) {
        const Vec3d area = area_vector(level, level.triangles[t]);
        const Vec3d flat = normalized(area);
        const LevelFacets::Leans lean = map.whole[t].leans();
        const LevelFacets::Floats share = map.whole[t].shares();
        double seen = 0, lit = 0;
        for (std::size_t i = 0; i < LevelFacets::kMax; ++i) {
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

TEST(FacetMap, AWrinkledPlateKeepsItsLightAsTwoTriangles) {
    const Mesh wrinkled = square_metre(400, 3e-3), flat = square_metre(1, 0);
    const FacetMap map = facets_of(wrinkled, flat, 6e-3);
    ASSERT_EQ(map.whole.size(), 2u);
    for (const double zenith : {0.0, 30.0, 60.0})
        for (const double azimuth : {0.0, 50.0, 110.0}) {
            const Look look{towards(20, 10), towards(zenith, azimuth)};
            EXPECT_NEAR(light_of(flat, map, look) / light_of(wrinkled, look), 1, 0.01)
                << zenith << " " << azimuth;
        }
    // With the Sun below the plate's own horizon only what leans towards it is lit.
    const Look behind{towards(60, 180), towards(93, 0)};
    EXPECT_EQ(light_of(flat, {std::vector(2, LevelFacets::flat()), {}, {}}, behind), 0);
    EXPECT_NEAR(light_of(flat, map, behind) / light_of(wrinkled, behind), 1, 0.15);
}

TEST(FacetMap, WhatIsFlatStaysFlat) {
    const Mesh fine = square_metre(50, 0), coarse = square_metre(1, 0);
    const FacetMap map = facets_of(fine, coarse, 1e-3);
    for (std::size_t t = 0; t < coarse.triangles.size(); ++t) EXPECT_TRUE(map.is_flat(t));
    EXPECT_TRUE(map.cells.empty());
}

TEST(FacetMap, TheOtherSideOfASheetIsNotItsOwn) {
    // Two plates back to back, nearer than the level's error; one of them wrinkled.
    Mesh sheet = square_metre(100, 3e-3), level = square_metre(1, 0);
    for (Mesh* mesh : {&sheet, &level}) {
        const auto first = static_cast<std::uint32_t>(mesh->vertices_m.size());
        const Mesh back = square_metre(1, 0);
        for (const Vec3f& v : back.vertices_m) mesh->vertices_m.push_back(v - Vec3f{0, 0, 1e-4f});
        for (const auto& t : back.triangles)
            mesh->triangles.push_back({first + t[0], first + t[2], first + t[1]});
        mesh->surface_of_triangle.assign(mesh->triangles.size(), 0);
    }
    const FacetMap map = facets_of(sheet, level, 1e-2);
    ASSERT_EQ(map.whole.size(), 4u);
    EXPECT_FALSE(map.is_flat(0));
    EXPECT_FALSE(map.is_flat(1));
    EXPECT_TRUE(map.is_flat(2));
    EXPECT_TRUE(map.is_flat(3));
}

TEST(FacetMap, EveryLevelHasOneOfAllItsTriangles) {
    const std::vector<MeshLevel> levels = coarser_levels(square_metre(200, 1e-3));
    ASSERT_GE(levels.size(), 3u);
    for (const MeshLevel& level : levels) EXPECT_TRUE(level.facets.is_whole(level.mesh.triangles.size()));
}

Vec3f mean_lean(const LevelFacets& facets) {
    const LevelFacets::Leans lean = facets.leans();
    const LevelFacets::Floats share = facets.shares();
    Vec3f sum{};
    for (std::size_t i = 0; i < LevelFacets::kMax; ++i)
        sum = sum + share[i] * Vec3f{lean.x[i], lean.y[i], lean.z[i]};
    return sum;
}

// A roof of 5 cm over a square metre, its ridge along y in the middle, on which a level has two flat triangles.
FacetMap roof() {
    Mesh fine = square_metre(64, 0);
    for (Vec3f& at : fine.vertices_m) at.z = 0.1f * std::min(at.x, 1 - at.x);
    return facets_of(fine, square_metre(1, 0), 0.06);
}

TEST(FacetMap, APixelSeesTheSideOfARoofWhereItIsAndAFarOneBoth) {
    const FacetMap map = roof();
    constexpr float kNear_m = 0.05f, kFar_m = 2, kSlope = 0.0995f;  // sine
    // The first triangle's corners are (0, 0), (1, 0) and (0, 1).
    EXPECT_NEAR(mean_lean(map.at({0, 0.1f, 0.2f}, kNear_m)).x, -kSlope, 1e-3f);
    EXPECT_NEAR(mean_lean(map.at({0, 0.8f, 0.1f}, kNear_m)).x, kSlope, 1e-3f);
    // Three quarters of it are on the one side.
    EXPECT_NEAR(mean_lean(map.at({0, 0.8f, 0.1f}, kFar_m)).x, -0.5f * kSlope, 2e-3f);
    EXPECT_EQ(&map.at({0, 0.1f, 0.2f}, kFar_m), &map.whole[0]);
}

TEST(FacetMap, CellsTogetherLeanAsTheWhole) {
    const FacetMap map = facets_of(square_metre(400, 3e-3), square_metre(1, 0), 6e-3);
    ASSERT_EQ(map.divisions[0].depth, FacetMap::kMaxDepth);
    for (const float width_m : {0.2f, 0.4f, 0.9f}) {
        Vec3f sum{};
        int count = 0;
        constexpr int kSteps = 240;
        for (int j = 0; j < kSteps; ++j)
            for (int i = 0; i + j < kSteps; ++i, ++count)
                sum = sum + mean_lean(map.at({0, (static_cast<float>(i) + 0.3f) / kSteps,
                                              (static_cast<float>(j) + 0.3f) / kSteps},
                                             width_m));
        EXPECT_NEAR(length(sum / static_cast<float>(count) - mean_lean(map.whole[0])), 0, 4e-3f) << width_m;
    }
}

TEST(FacetMap, SmallerPixelsSeeSmallerCellsAndEachCellIsSeen) {
    const FacetMap map = roof();
    const auto seen_by = [&](float width_m) {
        std::set<const LevelFacets*> cells;
        constexpr int kSteps = 100;
        for (int j = 0; j <= kSteps; ++j)
            for (int i = 0; i + j <= kSteps; ++i)
                cells.insert(
                    &map.at({0, static_cast<float>(i) / kSteps, static_cast<float>(j) / kSteps}, width_m));
        return cells.size();
    };
    EXPECT_EQ(seen_by(2.0f), 1u);
    EXPECT_EQ(seen_by(0.6f), 4u);
    EXPECT_EQ(seen_by(0.3f), 16u);
    EXPECT_EQ(seen_by(0.1f), 64u);
    EXPECT_EQ(seen_by(0), 64u);
}

TEST(FacetMap, WhatRoundingPutsBesideATriangleIsInIt) {
    const FacetMap map = roof();
    const auto is_own = [&](float u, float v) {
        const auto cell = static_cast<std::size_t>(&map.at({1, u, v}, 0) - map.cells.data());
        const FacetMap::Division& own = map.divisions[1];
        return cell >= own.first + 20 && cell < own.first + 84;  // those of the greatest depth
    };
    for (const float u : {-1e-3f, 0.0f, 0.5f, 1.0f, 1.001f, 1e9f, std::numeric_limits<float>::quiet_NaN()})
        for (const float v :
             {-1e-3f, 0.0f, 0.5f, 1.0f, 1.001f, 1e9f, std::numeric_limits<float>::quiet_NaN()})
            EXPECT_TRUE(is_own(u, v)) << u << " " << v;
}

TEST(FacetMap, OneThatLacksCellsIsNotWhole) {
    FacetMap map = roof();
    EXPECT_TRUE(map.is_whole(2));
    EXPECT_FALSE(map.is_whole(3));
    FacetMap deep = map, beyond = map;
    deep.divisions[0].depth = 31;
    EXPECT_FALSE(deep.is_whole(2));
    beyond.divisions[1].first = std::numeric_limits<std::uint32_t>::max();
    EXPECT_FALSE(beyond.is_whole(2));
    map.cells.pop_back();
    EXPECT_FALSE(map.is_whole(2));
}

}  // namespace
}  // namespace hilcam
