#include "render/sunlight/penumbra_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

// A small plate before a large one, the Sun over the camera's right shoulder, and out of the picture what throws a
// shadow on the large one. The small one's own shadow misses it.
class SunEdgesTest : public testing::Test {
  protected:
    Stage s;

    SunEdgesTest() {
        s.quality.visibility = "buffer";
        s.quality.buffer_samples = 64;
        s.quality.max_depth = 1;
        s.quality.rays_across = 0;  // plates as the picture's pixels see them
        s.camera(160, 0.3);
        s.sun({1, 0, -1});
    }
    // wrinkled: the large one is a level that has flattened wrinkles.
    void build(bool wrinkled) {
        add(0.25f, {0, 0, 3.5});
        add(1, {0, 0, 5});
        if (wrinkled) wrinkle(s.scene.objects.back());
        add(1.2f, kAway);
        s.build();
    }
    // Squares of a tenth of a pixel, one in each, that one sample sees.
    void build_dots() {
        constexpr float kPixel_m = 5 * 2 * 0.3f / 160;
        SceneObject object = plate(lambert(0.5), s.grid);
        const Mesh square = object.mesh;
        Mesh& dots = object.mesh;
        dots.vertices_m.clear(), dots.triangles.clear(), dots.surface_of_triangle.clear();
        for (int y = -20; y < 20; ++y)
            for (int x = -45; x < -20; ++x) {
                const auto first = static_cast<std::uint32_t>(dots.vertices_m.size());
                const Vec3f middle{static_cast<float>(x) + 3.5f / 8, static_cast<float>(y) + 3.5f / 8, 0};
                for (const Vec3f v : square.vertices_m)
                    dots.vertices_m.push_back(kPixel_m * (middle + 0.05f * v));
                for (const auto& t : square.triangles)
                    dots.triangles.push_back({first + t[0], first + t[1], first + t[2]});
            }
        dots.normals.clear(), dots.uvs.clear();
        dots.surface_of_triangle.resize(dots.triangles.size());
        s.add(std::move(object), {0, 0, 5});
        add(1.2f, kAway);
        s.build();
    }
    static constexpr Vec3d kAway{3, 30, 2};

    std::uint64_t rays_with_it_at(Vec3d position_m) {
        s.world.objects.back().position_world_m = position_m;
        s.render_again();
        return s.stats.shadow_rays;
    }
    // Radiance at a place of the picture, as a share of that of a plate in the Sun.
    float lit(int x_px, int y_px) const {
        const auto at = [&](int x, int y) { return s.radiance.row(y)[static_cast<std::size_t>(x)]; };
        return at(x_px, y_px) / at(80, 80);
    }

    // The farthest that the shadow's edge is from where it falls, while that goes over a pixel [px]. The Sun is far away, so that
    // the edge is sharp.
    double worst_place_px() {
        s.world.bodies.sun_world_m = 20.0 * s.world.bodies.sun_world_m;
        constexpr int kSteps = 16;
        constexpr double kPixel_m = 5 * 2 * 0.3 / 160;
        std::array<double, kSteps> off{};
        for (int i = 0; i < kSteps; ++i) {
            rays_with_it_at({3.6 + i * kPixel_m / kSteps, 0, 2});
            for (int y = 79; y < 81; ++y)
                for (int x = 35; x < 60; ++x)
                    off[static_cast<std::size_t>(i)] +=
                        0.5 * static_cast<double>(s.radiance.row(y)[static_cast<std::size_t>(x)] /
                                                  s.radiance.row(y)[30]);
            off[static_cast<std::size_t>(i)] -= static_cast<double>(i) / kSteps;
        }
        const auto [least, most] = std::minmax_element(off.begin(), off.end());
        return 0.5 * (*most - *least);
    }

  private:
    // Four facets that lean to all sides, where the mesh itself is flat.
    static void wrinkle(SceneObject& object) {
        constexpr float kLean = 0.3f;
        const LodNormals facets = LodNormals::of({LodNormals::Normal{{kLean, 0, 0}, 0.25f},
                                                  {{-kLean, 0, 0}, 0.25f},
                                                  {{0, kLean, 0}, 0.25f},
                                                  {{0, -kLean, 0}, 0.25f}},
                                                 0.1f);
        object.levels = {{object.mesh, 1e-6, {0.3f}, {object.mesh.triangles.size(), facets}}};
    }
    void add(float size, Vec3d position_m) {
        SceneObject object = plate(lambert(0.5), s.grid);
        for (Vec3f& v : object.mesh.vertices_m) v = size * v;
        s.add(std::move(object), position_m);
    }
};

// Where a plate in the Sun hides one that lies in shadow, no edge of a shadow falls on either.
TEST_F(SunEdgesTest, AnOutlineBeforeWhatIsDarkIsNone) {
    build(false);
    const std::uint64_t all_lit = rays_with_it_at(kAway);
    EXPECT_NEAR(lit(40, 80), 1, 1e-5);
    EXPECT_EQ(rays_with_it_at({3, 0, 2}), all_lit);
    EXPECT_EQ(lit(40, 80), 0);
}

// The large plate is 107 pixels high, and the edge runs down it beside the small one: two pixels of each row send
// four rays more. Where these differ, they and the pixels beside them send sixteen.
TEST_F(SunEdgesTest, VerticesOnBothSidesOfAShadowsEdgeAskAgain) {
    build(false);
    const std::uint64_t all_lit = rays_with_it_at(kAway);
    const std::uint64_t more = rays_with_it_at({3.6, 0, 2}) - all_lit;
    EXPECT_NEAR(lit(30, 80), 1, 1e-5);
    EXPECT_EQ(lit(130, 80), 0);
    EXPECT_GE(more, 107u * (2 * 4 + 16));
    EXPECT_LE(more, 109u * (2 * 4 + 4 * 16));
}

TEST_F(SunEdgesTest, WhatOneSampleSeesHasOneRay) {
    build_dots();
    const std::uint64_t all_lit = rays_with_it_at(kAway);
    EXPECT_EQ(all_lit, 40u * 25u);
    const float lit = s.radiance.row(80)[35], dark = s.radiance.row(80)[58];
    EXPECT_GT(lit, 0);
    EXPECT_NEAR(dark, lit, 0.01f * lit);
    EXPECT_EQ(rays_with_it_at({3.6, 0, 2}), all_lit);
    EXPECT_TRUE((s.radiance.row(80)[35] == 0) != (s.radiance.row(80)[58] == 0));
}

TEST_F(SunEdgesTest, AnEdgeFallsBetweenPixels) {
    build(false);
    EXPECT_LT(worst_place_px(), 0.07);
}

// Its light leaves each triangle's four facets, from all of the pixel that sees it.
TEST_F(SunEdgesTest, AnEdgeOnFlattenedWrinklesDoesToo) {
    build(true);
    EXPECT_LT(worst_place_px(), 0.07);
}

}  // namespace
}  // namespace hilcam
