#include "render/visibility/rolling_raster.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "tests/support/buffer_and_rays.h"
#include "tests/support/vector_widths.h"

namespace hilcam {
namespace {

// A camera that turns about all its axes, by 0.06 px of 300 from one row to the next: 180 deg/s with rows of 60 us.
constexpr Vec3d kTurn_rad_s{1.7, 2.4, -1.2};
constexpr double kLine_s = 60e-6;

// In a tile of 16 rows what is left out of an edge's turn is 16 px / 2 x 16 rows / 2 x 3.2 rad/s x 60 us = 0.012 px at its corners, and
// half of that beside most edges: one sample in a hundred of a pixel beside an edge. Each sample is taken for its own instant.
void expect_same_while_rolling(BufferAndRays& sight) {
    ASSERT_TRUE(sight.place());
    const BufferAndRays::Count count = sight.compare();
    EXPECT_GT(count.seen_by_both, 100'000);
    EXPECT_LT(count.only_rays + count.only_buffer, 5e-4 * count.seen_by_both);
    EXPECT_LT(count.other_triangle, 3e-3 * count.seen_by_both);
    // The same world at one instant is another picture.
    const RowMotion moving = *sight.rows;
    sight.rows->camera.velocity_world_m_s = sight.rows->camera.rate_body_rad_s = {};
    ASSERT_TRUE(sight.place());
    sight.rows = moving;
    const BufferAndRays::Count still = sight.compare();
    EXPECT_GT(still.only_rays + still.only_buffer + still.other_triangle,
              20 * (count.only_rays + count.only_buffer + count.other_triangle + 1));
}

TEST(RollingRaster, ACameraThatTurnsSeesInEachRowWhatRaysOfThatRowSee) {
    BufferAndRays sight(200, 150, 300);
    sight.add(debris(2000, 3, 1), turned({0, 0, 8}));
    sight.add(debris(2000, 3, 2), turned({2, 1, 9}));
    sight.roll({}, kTurn_rad_s, kLine_s);
    expect_same_while_rolling(sight);
}

// Near things move by more than far ones.
TEST(RollingRaster, ACameraThatPassesByNearThingsSeesInEachRowWhatRaysOfThatRowSee) {
    BufferAndRays sight(200, 150, 300);
    sight.add(debris(2000, 3, 1), turned({0, 0, 8}));
    sight.add(debris(2000, 3, 2), turned({2, 1, 20}));
    sight.roll({20, -12, 15}, {}, kLine_s);
    expect_same_while_rolling(sight);
}

TEST(RollingRaster, WhatGoesThroughTheCamerasPlaneIsCutInEachRowsPlane) {
    BufferAndRays sight(200, 150, 100);
    sight.add(debris(3000, 3, 3), turned({0, 0, 0.5}));
    sight.roll({0.6, -0.5, 0.4}, 0.5 * kTurn_rad_s, kLine_s);
    expect_same_while_rolling(sight);
}

TEST(RollingRaster, ALensThatBendsBendsWhatEachRowSees) {
    BufferAndRays sight(220, 160, 1600);
    bend(sight);
    sight.add(debris(2000, 2, 1), turned({3, 2, 8}));
    sight.add(debris(2000, 2, 2), turned({4, 2.5, 9}));
    sight.roll({}, 0.2 * kTurn_rad_s, kLine_s);
    expect_same_while_rolling(sight);
}

// Triangles that share an edge take the same numbers for it, in any row: from inside there is no way out.
TEST(RollingRaster, NoSampleIsLostInsideASphere) {
    for (const double focal_px : {60.0, 300.0}) {
        BufferAndRays sight(200, 150, focal_px);
        sight.add(sphere_mesh(1, 200), turned({0.3, 0.1, 0.2}));
        sight.roll({0.3, -0.2, 0.4}, kTurn_rad_s, kLine_s);
        ASSERT_TRUE(sight.place());
        const BufferAndRays::Count count = sight.compare();
        EXPECT_LE(count.samples - count.seen_by_both, 4) << focal_px;
    }
}

TEST(RollingRaster, WhatIsBesideThePictureIsLeftOutAndChangesNothing) {
    for (const Vec3d& at : {Vec3d{0, 0, 8}, Vec3d{3, 0, 5}, Vec3d{-0.5, 0.2, 0.3}, Vec3d{0, 0, -4}}) {
        BufferAndRays sight(200, 150, 300);
        sight.add(debris(4000, 3, 6), turned(at));
        sight.roll({0.3, -0.2, 0.4}, kTurn_rad_s, kLine_s);
        ASSERT_TRUE(sight.place());
        const std::vector<std::uint32_t> all = ids_of(sight);
        sight.with_boxes = true;
        ASSERT_TRUE(sight.place());
        EXPECT_EQ(ids_of(sight), all) << at.x << " " << at.z;
    }
}

TEST(RollingRaster, SeesTheSameWithVectorsOfAnyWidth) {
    BufferAndRays sight(200, 150, 300);
    sight.add(debris(1501, 3, 5), turned({0, 0, 8}));
    sight.add(sphere_mesh(1, 50), turned({0.3, 0.1, 1.2}));
    sight.roll({0.3, -0.2, 0.4}, kTurn_rad_s, kLine_s);
    expect_same_by_any_width([&] {
        EXPECT_TRUE(sight.place());
        return ids_of(sight);
    });
}

TEST(RollingRaster, SeesTheSameOnAnyNumberOfThreads) {
    BufferAndRays sight(200, 150, 300);
    sight.add(debris(4000, 3, 6), turned({0, 0, 8}));
    sight.roll({0.3, -0.2, 0.4}, kTurn_rad_s, kLine_s);
    ASSERT_TRUE(sight.place());
    const std::vector<std::uint32_t> several = ids_of(sight);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    ASSERT_TRUE(sight.place());
    EXPECT_EQ(ids_of(sight), several);
}

// Rows that see what moves by more than a quarter of a pixel from one to the next are for rays: by turning, by passing a thing nearby,
// or by a turn of more than 0.2 rad to either side.
TEST(RollingRaster, SaysWhenWhatRowsSeeMovesTooFast) {
    const auto takes = [](Vec3d velocity_m_s, Vec3d rate_rad_s, double line_s) {
        BufferAndRays sight(200, 150, 300);
        sight.add(sphere_mesh(1, 20), turned({0, 0, 4}));
        sight.roll(velocity_m_s, rate_rad_s, line_s);
        return sight.place();
    };
    constexpr double kLine = 1e-4;
    EXPECT_TRUE(takes({}, {0, 7, 0}, kLine));    // 0.21 px a row in the middle, 0.24 at the sphere's sides
    EXPECT_FALSE(takes({}, {0, 9, 0}, kLine));   // 0.27
    EXPECT_TRUE(takes({20, 0, 0}, {}, kLine));   // 0.2 px at its nearest, 3 m away
    EXPECT_FALSE(takes({28, 0, 0}, {}, kLine));  // 0.28
    EXPECT_TRUE(
        takes({}, {0, 0, 24}, kLine));  // 0.19 rad to either side, about the boresight: 0.18 px at the rim
    EXPECT_FALSE(takes({}, {0, 0, 28}, kLine));
}

}  // namespace
}  // namespace hilcam
