// What rows of several instants see of an edge, against where geometry has it in each row, and pictures out of the visibility buffer
// against pictures out of rays through the same places of each row.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/difference_from_rays.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

constexpr double kLine_s = 100e-6;

Stage rolling_stage() {
    Stage s;
    s.models.rays = {"rolling", kLine_s};
    s.quality.path_model = "direct";
    s.quality.visibility = "buffer";
    s.quality.buffer_samples = 64;
    s.quality.rays_across = 0;
    s.sun({0, 0, -1});
    return s;
}

// A white sheet from its left edge on, which leans by 35 degrees and reaches far beyond the picture on all other sides.
SceneObject sheet(const SpectralGrid& grid) {
    const double lean_rad = 35 * kDegree_rad;
    const Vec3d along{std::sin(lean_rad), std::cos(lean_rad), 0}, across{along.y, -along.x, 0};
    std::vector<Vec3f> corners;
    for (const double x : {0.0, 40.0})
        for (const double y : {-40.0, 40.0}) corners.push_back(to_float(x * across + y * along));
    return object_of(corners, {{0, 2, 1}, {1, 2, 3}}, lambert(0.5), grid);
}

// Where the edge crosses a row's middle, at that row's instant [padded px].
double edge_px(const Stage& s, int row) {
    const RowMotion motion{
        {s.world.time, s.world.camera, s.world.rows_velocity_m_s, s.world.camera_rate_rad_s},
        kLine_s,
        0.5 * s.geometry.height_px};
    const double y_px = row + 0.5 - s.geometry.guard_px;
    const Pose at = motion.pose_at(y_px);
    const auto seen = [&](Vec3d corner_m) {
        const Vec3d world_m =
            s.world.objects[0].position_world_m + to_matrix(s.world.objects[0].world_from_body) * corner_m;
        return s.geometry.project_px(transposed(to_matrix(at.world_from_body)) *
                                     (world_m - at.position_world_m));
    };
    const Vec2d p = seen(to_double(s.scene.objects[0].mesh.vertices_m[0])),
                q = seen(to_double(s.scene.objects[0].mesh.vertices_m[1]));
    return p.x + (y_px - p.y) / (q.y - p.y) * (q.x - p.x) + s.geometry.guard_px;
}

// The greatest distance, over all rows, between where the light of a row begins and where geometry has the edge. A row's light is a
// sum over pixels: what part of each is covered.
double greatest_error_px(Stage& s) {
    s.render();
    EXPECT_EQ(s.stats.primary_rays, 0u);
    const int width = s.radiance.width();
    const double all = static_cast<double>(s.radiance.row(20, 0)[static_cast<std::size_t>(width - 1)]);
    EXPECT_GT(all, 0);
    double greatest = 0;
    for (int row = 0; row < s.radiance.height(); ++row) {
        double sum = 0;
        for (const float light : s.radiance.row(row, 0)) sum += static_cast<double>(light);
        greatest = std::max(greatest, std::abs(width - sum / all - edge_px(s, row)));
    }
    return greatest;
}

// A row of pixels has eight rows of samples. A slanted edge crosses each at another place, so the row's sum is right to a fraction of
// a sample: 0.02 px.
TEST(RollingShutter, AnEdgeLiesInEachRowWhereGeometryHasItAtThatRowsInstant) {
    struct Case {
        Vec3d velocity_m_s, rate_rad_s;
        double moves_px;  // from the upper row to the lower, at least
    };
    for (const Case& c : {Case{{}, {0, 30 * kDegree_rad, 0}, 0.05}, Case{{}, {-1.0, 3.0, 2.0}, 0.3},
                          Case{{2.0, -1.0, 0.5}, {}, 0.02}, Case{{-25.0, 5.0, 8.0}, {0.5, -2.0, 1.0}, 0.3}}) {
        Stage s = rolling_stage();
        s.add(sheet(s.grid), {0.1, 0.05, 6});
        s.world.rows_velocity_m_s = c.velocity_m_s, s.world.camera_rate_rad_s = c.rate_rad_s;
        EXPECT_LT(greatest_error_px(s), 0.02);
        // One instant for all rows would be off by half of the way that the edge takes.
        Stage still = rolling_stage();
        still.add(sheet(s.grid), {0.1, 0.05, 6});
        const double moved_px = (edge_px(s, 39) - edge_px(still, 39)) - (edge_px(s, 0) - edge_px(still, 0));
        EXPECT_GT(std::abs(moved_px), c.moves_px);
    }
}

// A pixel's row is one instant to rays, and to the buffer its middle is: beside the upper and lower border of a row some samples of an
// edge differ, by as much of a pixel as things move in half a row, here 0.05 px at most.
TEST(RollingShutter, ACubeIsWhatRaysSee) {
    Stage s = rolling_stage();
    s.sun({0.3, 0.5, -1});
    s.add(cube(lambert(0.5), s.grid), {0.2, -0.1, 3}, {0.4, 0.7, -0.2});
    s.world.camera_rate_rad_s = {-10, 20, 10};
    s.world.rows_velocity_m_s = {2, -3, 4};
    const Difference d = difference_from_rays(s, 8);
    EXPECT_NEAR(d.covered, 0, 2e-4);
    EXPECT_LT(std::abs(d.mean), 1e-3);
    EXPECT_LT(d.greatest, 0.1);
}

// The boxes in which bodies are looked for are as much wider as the camera turns: the limb is where rays of all rows have it.
TEST(RollingShutter, TheEarthBehindACubeIsWhatRaysSee) {
    for (const double x_m : {9e6, -24e6}) {  // in the middle, and at the edge of the picture
        Stage s = rolling_stage();
        s.earth(0.3);
        s.world.bodies[BodyId::kEarth].world_m = {x_m, 0, 3e7};
        s.sun({0.3, 0.5, -1});
        s.add(cube(lambert(0.5), s.grid), {0.2, -0.1, 3}, {0.4, 0.7, -0.2});
        s.world.camera_rate_rad_s = {-10, 50, 10};
        const Difference d = difference_from_rays(s, 8);
        EXPECT_LT(std::abs(d.mean), 2e-3);
        EXPECT_LT(d.greatest, 0.14);
    }
}

// What moves by more than a quarter of a pixel from one row to the next is left to rays, sixteen a pixel.
TEST(RollingShutter, WhatMovesTooFastIsLeftToRays) {
    Stage s = rolling_stage();
    s.add(cube(lambert(0.5), s.grid), {0.2, -0.1, 3}, {0.4, 0.7, -0.2});
    s.world.camera_rate_rad_s = {0, 90, 0};  // 0.29 px a row
    s.render();
    EXPECT_GT(s.stats.primary_rays, 1000u);
}

}  // namespace
}  // namespace hilcam
