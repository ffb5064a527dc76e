#include "render/scene/coplanar_groups.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "render/scene/surface.h"
#include "render/visibility/fragment_packet.h"
#include "render/visibility/visibility_buffer.h"
#include "tests/support/wavy_plate.h"

namespace hilcam {
namespace {

// A plate of 2 x 2 m that leans against all axes, so that its corners are rounded; waves on it have no symmetry.
Mesh leaning_plate(int steps, double amplitude_m = 0) {
    Mesh mesh = wavy_plate(steps, -1.03, 0.97, amplitude_m);
    const Mat3d turn = to_matrix(normalized(Quat{0.8, 0.3, -0.4, 0.2}));
    for (Vec3f& at : mesh.vertices_m) at = to_float(turn * to_double(at) + Vec3d{2, 3, 1});
    return mesh;
}

ObjectSurfaces surfaces_of(const Mesh& mesh) {
    ObjectSurfaces out(mesh, std::vector<Material>(mesh.surfaces.size()),
                       std::make_shared<const std::vector<MipTexture>>());
    find_coplanar_groups(mesh, out);
    return out;
}

std::size_t group_count(const ObjectSurfaces& surfaces) {
    return std::set<std::uint32_t>(surfaces.coplanar_groups.begin(), surfaces.coplanar_groups.end()).size();
}

TEST(CoplanarGroups, APlateIsOne) {
    const ObjectSurfaces surfaces = surfaces_of(leaning_plate(16));
    ASSERT_EQ(surfaces.coplanar_groups.size(), 512u);
    EXPECT_EQ(group_count(surfaces), 1u);
    const std::uint32_t one = surfaces.coplanar_groups[0];
    EXPECT_EQ(surfaces.coplanar_groups[one], one);
    for (std::uint32_t t = 0; t < 512; ++t) EXPECT_EQ(surfaces.triangles[t].coplanar_group, t == one ? 1 : 0);
}

TEST(CoplanarGroups, WhatLiesOtherwiseStaysByItself) {
    EXPECT_TRUE(surfaces_of(leaning_plate(16, 2e-2)).coplanar_groups.empty()) << "waves";

    Mesh mesh = leaning_plate(16);
    mesh.surfaces.resize(2);
    for (std::size_t t = 0; t < 100; ++t) mesh.surface_of_triangle[t] = 1;
    EXPECT_EQ(group_count(surfaces_of(mesh)), 2u) << "another surface";

    mesh = leaning_plate(16);
    for (std::size_t t = 0; t < 100; ++t) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
    EXPECT_EQ(group_count(surfaces_of(mesh)), 2u) << "the other side";

    // Another plate 0.1 mm above the first.
    mesh = leaning_plate(4);
    const Vec3f up = 1e-4f * to_float(normalized(area_vector(mesh, mesh.triangles[0])));
    const auto count = static_cast<std::uint32_t>(mesh.vertices_m.size());
    for (std::uint32_t i = 0; i < count; ++i) mesh.vertices_m.push_back(mesh.vertices_m[i] + up);
    for (std::size_t t = 0; t < 32; ++t) {
        const auto [a, b, c] = mesh.triangles[t];
        mesh.triangles.push_back({a + count, b + count, c + count});
        mesh.surface_of_triangle.push_back(0);
    }
    EXPECT_EQ(group_count(surfaces_of(mesh)), 2u) << "another plane";
}

TEST(CoplanarGroups, NormalsColoursAndWrinklesOfTheirOwnKeepTrianglesApart) {
    Mesh smooth = leaning_plate(4);
    for (const Vec3f& at : smooth.vertices_m) smooth.normals.push_back(normalized(at));
    EXPECT_TRUE(surfaces_of(smooth).coplanar_groups.empty());
    smooth.normals.assign(smooth.vertices_m.size(), Vec3f{0, 0, 1});
    EXPECT_EQ(group_count(surfaces_of(smooth)), 1u) << "one normal";

    Mesh colored = leaning_plate(4);
    colored.colors.assign(colored.vertices_m.size(), Vec3f{1, 1, 1});
    EXPECT_TRUE(surfaces_of(colored).coplanar_groups.empty());

    const Mesh flat = leaning_plate(4);
    ObjectSurfaces level(flat, std::vector<Material>(1), std::make_shared<const std::vector<MipTexture>>());
    level.lod_normals.assign(flat.triangles.size(), LodNormals::of({LodNormals::Normal{{0.1f, 0, 0}, 1}}, 0));
    find_coplanar_groups(flat, level);
    EXPECT_TRUE(level.coplanar_groups.empty());
}

TEST(CoplanarGroups, AreTheSameOnAnyNumberOfThreads) {
    const Mesh mesh = leaning_plate(120);
    const ObjectSurfaces by_many = surfaces_of(mesh);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(surfaces_of(mesh).coplanar_groups, by_many.coplanar_groups);
    // No farther from what stands for them than rays' places are kept to; so these are several.
    EXPECT_GT(group_count(by_many), 1u);
    EXPECT_LT(group_count(by_many), 100u);
}

// What stands for a group is met where the triangle itself would be, to the rounding of either.
TEST(CoplanarGroups, AreMetWhereTheirTrianglesAre) {
    const Mesh mesh = leaning_plate(16);
    const ObjectSurfaces surfaces = surfaces_of(mesh);
    ObjectSurfaces alone = surfaces;
    for (PackedTriangle& triangle : alone.triangles) triangle.coplanar_group = 0;
    const Vec3f eye_m{20, 5, -4};
    float max_m = 0;
    for (std::uint32_t first = 0; first < 512; first += FragmentPacket::kSize) {
        FragmentPacket own, all;
        own.count = all.count = FragmentPacket::kSize;
        for (std::uint32_t k = 0; k < FragmentPacket::kSize; ++k) {
            const auto& [a, b, c] = mesh.triangles[first + k];
            const Vec3f at = (mesh.vertices_m[a] + mesh.vertices_m[b] + mesh.vertices_m[c]) / 3.0f;
            for (FragmentPacket* packet : {&own, &all})
                packet->dir.set(k, at - eye_m), packet->origin.set(k, eye_m);
            own.triangle[k] = first + k, all.triangle[k] = surfaces.coplanar_groups[first + k];
        }
        const Mat3f still{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        find_surface_frames({mesh.vertices_m.data(), mesh.triangles.data(), alone.triangles.data(), still},
                            own);
        find_surface_frames({mesh.vertices_m.data(), mesh.triangles.data(), surfaces.triangles.data(), still},
                            all);
        for (std::size_t k = 0; k < FragmentPacket::kSize; ++k) {
            EXPECT_LT(length(all.geometric.at(k) - own.geometric.at(k)), 1e-5f);
            EXPECT_EQ(all.back[k], own.back[k]);
            max_m = std::max(max_m, std::abs(all.distance[k] - own.distance[k]) * length(own.dir.at(k)));
        }
    }
    // A ray that leaves a surface begins 16 half-ulps of the greatest coordinate above it: 4e-5 m here.
    EXPECT_LT(max_m, 1e-5f);
}

TEST(CoplanarGroups, AreOneIdOfTheVisibilityBuffer) {
    const Mesh mesh = leaning_plate(16);
    const ObjectSurfaces surfaces = surfaces_of(mesh);
    ImageGeometry geometry;
    geometry.width_px = geometry.height_px = 64, geometry.focal_length_px = 64;
    VisibilityBuffer buffer(geometry, {1, mesh.vertices_m.size(), mesh.triangles.size()});
    Pose camera;
    camera.position_world_m = {2, 3, -2};
    const std::vector<VisibilityBuffer::Shown> shown = {
        {0, {}, surfaces.radius_m, {mesh.vertices_m, mesh.triangles}, {}, surfaces.coplanar_groups}};
    ASSERT_TRUE(buffer.place(camera, shown));
    std::set<std::uint32_t> ids;
    VisibilityTile tile;
    buffer.fill_all(tile, [&](int, int) { ids.insert(tile.id.begin(), tile.id.end()); });
    EXPECT_EQ(ids, (std::set{surfaces.coplanar_groups[0], VisibilityTile::kNothing}));
}

}  // namespace
}  // namespace hilcam
