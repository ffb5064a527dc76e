// Where the truth has things in a frame: through lenses, binned and mirrored, row by row, and stars.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/truth_stage.h"

namespace hilcam {
namespace {

// Distortion after Brown, by hand: x' = x (1 + k1 r^2) + 2 p1 x y + p2 (r^2 + 2 x^2).
TEST(Truth, PlacesAreThoseOfTheLensWithItsDistortion) {
    TruthStage s;
    s.geometry.distortion.k1 = -0.2;
    s.geometry.distortion.p1 = 0.01;
    s.geometry.distortion.p2 = 0.02;
    s.geometry.principal_offset_px = {3, -2};
    s.add(cube(lambert(0.5), s.grid, 0.4f), {1.2, 0.6, 4}, {});
    const FrameTruth t = s.tell();
    const double x = 0.3, y = 0.15, r2 = x * x + y * y;
    const double xd = x * (1 - 0.2 * r2) + 2 * 0.01 * x * y + 0.02 * (r2 + 2 * x * x);
    const double yd = y * (1 - 0.2 * r2) + 0.01 * (r2 + 2 * y * y) + 2 * 0.02 * x * y;
    EXPECT_NEAR(t.things[0].center_px.x, 64 + 3 + 128 * xd, 1e-9);
    EXPECT_NEAR(t.things[0].center_px.y, 64 - 2 + 128 * yd, 1e-9);
    // The front face's own ray: the position over the depth is the undistorted place.
    const int px = static_cast<int>(t.things[0].center_px.x), py = static_cast<int>(t.things[0].center_px.y);
    ASSERT_EQ(value_at(t.layers.object, px, py), 1u);
    const Vec3d p = vector_at(t.layers.position_m, px, py);
    const double u = p.x / p.z, v = p.y / p.z, q2 = u * u + v * v;
    EXPECT_NEAR(64 + 3 + 128 * (u * (1 - 0.2 * q2) + 0.02 * u * v + 0.02 * (q2 + 2 * u * u)), px + 0.5, 1e-4);
    EXPECT_NEAR(64 - 2 + 128 * (v * (1 - 0.2 * q2) + 0.01 * (q2 + 2 * v * v) + 0.04 * u * v), py + 0.5, 1e-4);
}

// k1 = -1 folds at a tangent of 1 / sqrt 3: a thing beyond it has no place, though the polynomial gives one
// in the frame, 64 + 256 * 0.9 * (1 - 0.81) px.
TEST(Truth, WhatTheLensFoldsBackHasNoPlace) {
    TruthStage s;
    s.camera(128, 0.25);
    s.geometry.distortion.k1 = -1;
    s.add(cube(lambert(0.5), s.grid), {9, 0, 10}, {});
    EXPECT_FALSE(s.tell().things[0].has_center);
    s.world.objects[0].position_world_m = {2, 0, 10};
    s.render_again();
    FrameTruth t = s.renderer->make_truth(s.request, 128, 128);
    t.raster = s.raster;
    s.renderer->report_truth(t);
    ASSERT_TRUE(t.things[0].has_center);
    EXPECT_NEAR(t.things[0].center_px.x, 64 + 256 * 0.2 * (1 - 0.04), 1e-9);
}

// The same of what is drawn as points: a cube of less than a pixel, a lamp. Nothing of them
// is in the picture, whichever way rows are read.
TEST(Truth, WhatTheLensFoldsBackLeavesNoGhost) {
    for (const std::string& rays :
         {std::string("pinhole"), std::string("rolling"), std::string("pushbroom")}) {
        TruthStage s;
        s.camera(128, 0.25);
        s.models.rays.model = rays;
        s.models.rays.line_time_s = 1e-3;
        s.world.camera_rate_rad_s = {rays == "pushbroom" ? 1.0 / 256 / 1e-3 : 1e-3, 0, 0};
        s.geometry.distortion.k1 = -1;
        const auto points_at = [&](double tangent) {
            s.world.objects = {{{1e3 * tangent, 0, 1e3}, {}}};
            s.scene.lamps = {{"lamp", 0, s.scene.sun_irradiance_1au_w_m2_um, {}}};
            s.world.lamps.resize(1);
            s.world.lamps[0] = {{50 * tangent, 1, 50}, {0, 0, 1}, 1};
            s.render();
            return s.points.size();
        };
        s.add(cube(lambert(0.5), s.grid), {}, {});
        EXPECT_GE(points_at(0.2), 2u) << rays;
        EXPECT_EQ(points_at(0.9), 0u) << rays;
    }
}

// Two by two px are one, and columns run backwards. The front face, 2.5 m away, reaches from 64 to 115.2 px
// and from 38.4 to 89.6; middles of the frame's own pixels are at odd numbers, of which 65 to 115 and 39 to
// 89 lie inside.
TEST(Truth, BinnedAndMirroredFramesHaveTheirOwnPixels) {
    TruthStage s;
    s.add(cube(lambert(0.5), s.grid), {0.5, 0, 3}, {});
    s.raster = {64, 64, {-2, 128}, {2, 0}};
    const FrameTruth t = s.tell();
    EXPECT_EQ(t.layers.object.width(), 64);
    expect_box(t.things[0].visible_box_px, {(127 - 115) / 2, 19, (127 - 65) / 2 + 1, 45});
    EXPECT_EQ(t.things[0].visible_px, 26u * 26u);
    EXPECT_NEAR(t.things[0].center_px.x, (128 - (64 + 128 * 0.5 / 3)) / 2, 1e-9);
    EXPECT_NEAR(t.things[0].center_px.y, 32, 1e-9);
    EXPECT_EQ(value_at(t.layers.object, 31, 32), 1u);
    EXPECT_EQ(value_at(t.layers.object, 33, 32), kSkyId);
    EXPECT_NEAR(vector_at(t.layers.position_m, 31, 32).x, 2.5 * 1.0 / 128, 2e-6);
}

// Ten black columns before the picture.
TEST(Truth, BlackColumnsSeeNothing) {
    TruthStage s;
    SceneObject wall = plate(lambert(0.5), s.grid);
    for (Vec3f& v : wall.mesh.vertices_m) v = 100.0f * v;
    s.add(std::move(wall), {0, 0, 10});
    s.raster = {128, 128, {1, -10}, {1, 0}};
    const FrameTruth t = s.tell();
    EXPECT_EQ(value_at(t.layers.object, 9, 64), kSkyId);
    EXPECT_EQ(value_at(t.layers.object, 10, 64), 1u);
    EXPECT_EQ(t.things[0].visible_px, 118u * 128u);
    EXPECT_NEAR(t.things[0].center_px.x, 74, 1e-9);
}

// The truth's stars are the points that are drawn, by number; one is hidden, one outside.
TEST(Truth, StarsInViewAreThoseThatAreDrawn) {
    TruthStage s;
    const auto star = [](Vec3d dir, std::uint32_t row) {
        Star out;
        out.world_dir = normalized(dir);
        out.irradiance_w_m2_um[0] = 1e-8f;
        out.magnitude_v = static_cast<float>(row);
        out.row = row, out.hd = 100 + row;
        return out;
    };
    s.scene.stars = {star({0.25, -0.125, 1}, 0), star({0, 0, 1}, 1), star({3, 0, 1}, 2),
                     star({-0.3, 0.1, 1}, 3), star({-0.3, 0.2, 1}, 9)};
    s.add(plate(lambert(0.5), s.grid), {0, 0, 8});
    s.request.faintest_magnitude = 5;
    const FrameTruth t = s.tell();
    ASSERT_EQ(t.stars.size(), 2u);
    EXPECT_EQ(t.stars[0].row, 0u);
    EXPECT_EQ(t.stars[0].hd, 100u);
    EXPECT_NEAR(t.stars[0].position_px.x, 64 + 32, 1e-9);
    EXPECT_NEAR(t.stars[0].position_px.y, 64 - 16, 1e-9);
    EXPECT_EQ(t.stars[1].hd, 103u);
    ASSERT_EQ(s.points.size(), 3u);  // the faint one, too
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(t.stars[i].position_px.x, s.points[i].position_px.x, 1e-5);
        EXPECT_NEAR(t.stars[i].position_px.y, s.points[i].position_px.y, 1e-5);
        EXPECT_EQ(t.stars[i].irradiance_w_m2_um[0], s.points[i].irradiance_w_m2_um[0]);
    }
    EXPECT_EQ(t.stars_left_out, 0u);
}

// With a pose for each row: the middle row is of the frame's instant, and one that is read later sees the
// cube where the camera has turned to by then.
TEST(Truth, ARollingShutterHasAPoseForEachRow) {
    TruthStage s;
    s.models.rays.model = "rolling";
    s.models.rays.line_time_s = 1e-3;
    s.world.camera_rate_rad_s = {0, 1, 0};  // the picture goes left by a px each ms, 128 px a radian
    s.add(cube(lambert(0.5), s.grid), {0, 0.9, 4}, {});
    const FrameTruth t = s.tell();
    const SeenThing& thing = t.things[0];
    ASSERT_TRUE(thing.has_center);
    // y = 64 + 0.225 * 128 = 92.8: some 28.8 ms after the middle, turned by 0.0288 rad, which moves it left
    // by 128 tan(0.0288) (and changes y by a cosine's error, 128 * 0.225 * 0.0288^2 / 2 = 0.012 px).
    const double turned_rad = 28.8e-3;
    EXPECT_NEAR(thing.center_px.x, 64 - 128 * std::tan(turned_rad), 0.02);
    EXPECT_NEAR(thing.center_px.y, 64 + 128 * 0.225, 0.02);
    // Its pixels lie about there, too.
    EXPECT_NEAR(thing.visible_center_px.x, thing.center_px.x, 1.5);
    EXPECT_GT(thing.visible_px, 500u);
}

}  // namespace
}  // namespace hilcam
