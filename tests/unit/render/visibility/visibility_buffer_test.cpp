#include "render/visibility/visibility_buffer.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "tests/support/buffer_and_rays.h"
#include "tests/support/vector_widths.h"

namespace hilcam {
namespace {

// A sphere's triangles share all their edges: where it is seen, no sample is lost between two of them.
TEST(VisibilityBuffer, SeesWhatRaysSee) {
    BufferAndRays sight(200, 150, 300);
    sight.add(sphere_mesh(1, 100), turned({0.1, -0.05, 4}));
    ASSERT_TRUE(sight.place());
    const BufferAndRays::Count count = sight.compare();
    EXPECT_GT(count.seen_by_both, 100'000);
    EXPECT_LE(count.only_rays + count.only_buffer, 3);
    EXPECT_LT(count.other_triangle, 1e-3 * count.seen_by_both);
}

// Rounding may decide a sample on an edge, or one where two triangles cross.
void expect_same(BufferAndRays& sight) {
    ASSERT_TRUE(sight.place());
    const BufferAndRays::Count count = sight.compare();
    EXPECT_GT(count.seen_by_both, 100'000);
    EXPECT_LT(count.only_rays + count.only_buffer, 1e-4 * count.seen_by_both);
    EXPECT_LT(count.other_triangle, 1e-3 * count.seen_by_both);
}

TEST(VisibilityBuffer, SeesTrianglesOfAllSizesInFrontOfEachOther) {
    BufferAndRays sight(200, 150, 300);
    sight.add(debris(2000, 3, 1), turned({0, 0, 8}));
    sight.add(debris(2000, 3, 2), turned({2, 1, 9}));
    expect_same(sight);
}

// The camera is among the triangles: some go through its plane.
TEST(VisibilityBuffer, CutsWhatGoesThroughTheCamerasPlane) {
    BufferAndRays sight(200, 150, 100);
    sight.add(debris(3000, 3, 3), turned({0, 0, 0.5}));
    expect_same(sight);
}

// Bars of 2 mm, 0.4 mm above a panel that is seen aslant from 50 m: long triangles of a twentieth of a pixel.
TEST(VisibilityBuffer, TellsThinPartsFromWhatTheyLieOn) {
    Mesh mesh;
    const auto add_strip = [&](float x0, float x1, float z) {
        const auto n = static_cast<std::uint32_t>(mesh.vertices_m.size());
        for (const float x : {x0, x1})
            for (const float y : {-1.2f, 1.2f}) mesh.vertices_m.push_back({x, y, z});
        mesh.triangles.push_back({n, n + 1, n + 2});
        mesh.triangles.push_back({n + 2, n + 1, n + 3});
    };
    add_strip(-1.2f, 1.2f, 0);
    for (float x = -1.19f; x < 1.18f; x += 0.01f) add_strip(x, x + 0.002f, 0.0004f);
    mesh.surface_of_triangle.resize(mesh.triangles.size());
    const double tilt_rad = 75 * kDegree_rad;
    BufferAndRays sight(200, 150, 1636);
    sight.add(std::move(mesh), {{1.1, -0.9, 50},
                                Quat{std::cos(tilt_rad / 2), std::sin(tilt_rad / 2), 0, 0} *
                                    Quat{std::cos(0.3), 0, 0, std::sin(0.3)}});
    ASSERT_TRUE(sight.place());
    const BufferAndRays::Count count = sight.compare();
    EXPECT_GT(count.seen_by_both, 20'000);
    EXPECT_LT(count.other_triangle, 1e-3 * count.seen_by_both);
}

// As a tile has the lens, its samples see what rays see; against the lens itself edges are off by hundredths
// of a pixel.
TEST(VisibilityBuffer, SeesThroughALensThatBends) {
    BufferAndRays sight(220, 160, 1600);
    bend(sight);
    ASSERT_TRUE(VisibilityBuffer::takes(sight.geometry));
    sight.add(debris(2000, 2, 1), turned({3, 2, 8}));
    sight.add(debris(2000, 2, 2), turned({4, 2.5, 9}));
    ASSERT_TRUE(sight.place());
    const BufferAndRays::Count own = sight.compare(true);
    EXPECT_GT(own.seen_by_both, 100'000);
    EXPECT_LT(own.only_rays + own.only_buffer, 1e-4 * own.seen_by_both);
    EXPECT_LT(own.other_triangle, 1e-3 * own.seen_by_both);
    const BufferAndRays::Count exact = sight.compare();
    EXPECT_LT(exact.only_rays + exact.only_buffer, 1e-3 * exact.seen_by_both);
    EXPECT_LT(exact.other_triangle, 2e-3 * exact.seen_by_both);
}

// Triangles around the camera, through its plane, beside the picture: none is lost through the lens.
TEST(VisibilityBuffer, LosesNoSampleInsideASphereBehindALensThatBends) {
    BufferAndRays sight(220, 160, 1600);
    bend(sight);
    sight.add(sphere_mesh(1, 200), turned({0.3, 0.1, 0.2}));
    ASSERT_TRUE(sight.place());
    const BufferAndRays::Count count = sight.compare(true);
    EXPECT_LE(count.samples - count.seen_by_both, 2);
}

TEST(VisibilityBuffer, LeavesLensesThatBendMuchToRays) {
    BufferAndRays sight(220, 160, 1600);
    bend(sight);
    EXPECT_TRUE(VisibilityBuffer::takes(sight.geometry));
    sight.geometry.distortion.k1 = -3;  // folds over
    EXPECT_FALSE(VisibilityBuffer::takes(sight.geometry));
    sight.geometry.distortion = {.projection = Projection::kFisheye};
    EXPECT_FALSE(VisibilityBuffer::takes(sight.geometry));
    BufferAndRays wide(200, 150, 100);
    wide.geometry.distortion.k1 = -0.1;
    EXPECT_FALSE(VisibilityBuffer::takes(wide.geometry));
}

// From inside there is no way out.
TEST(VisibilityBuffer, LosesNoSampleInsideASphere) {
    BufferAndRays sight(200, 150, 60);
    sight.add(sphere_mesh(1, 200), turned({0.3, 0.1, 0.2}));
    ASSERT_TRUE(sight.place());
    const BufferAndRays::Count count = sight.compare();
    EXPECT_LE(count.samples - count.seen_by_both, 2);
}

// Vectors of another width than this processor's are for other processors: their frames must be these.
TEST(VisibilityBuffer, SeesTheSameWithVectorsOfAnyWidth) {
    BufferAndRays sight(200, 150, 300);
    sight.add(debris(1501, 3, 5), turned({0, 0, 8}));
    sight.add(sphere_mesh(1, 50), turned({0.3, 0.1, 1.2}));
    expect_same_by_any_width([&] {
        EXPECT_TRUE(sight.place());
        return ids_of(sight);
    });
}

// A processor's threads sort triangles in any order.
TEST(VisibilityBuffer, SeesTheSameOnAnyNumberOfThreads) {
    BufferAndRays sight(200, 150, 300);
    sight.add(debris(4000, 3, 6), turned({0, 0, 8}));
    ASSERT_TRUE(sight.place());
    const std::vector<std::uint32_t> several = ids_of(sight);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    ASSERT_TRUE(sight.place());
    EXPECT_EQ(ids_of(sight), several);
}

// Beside the picture, behind the camera, about it, and wherever else.
TEST(VisibilityBuffer, WhatIsBesideThePictureIsLeftOutAndChangesNothing) {
    for (const Vec3d& at : {Vec3d{0, 0, 8}, Vec3d{3, 0, 5}, Vec3d{-0.5, 0.2, 0.3}, Vec3d{0, 0, -4}}) {
        BufferAndRays sight(200, 150, 300);
        sight.add(sphere_mesh(2, 60), turned(at)), sight.add(debris(4000, 3, 6), turned(at));
        ASSERT_TRUE(sight.place());
        const std::vector<std::uint32_t> all = ids_of(sight);
        sight.with_boxes = true;
        ASSERT_TRUE(sight.place());
        EXPECT_EQ(ids_of(sight), all) << at.x << " " << at.z;
    }
}

TEST(VisibilityBuffer, SaysWhenAFrameShowsMoreThanThereIsRoomFor) {
    BufferAndRays sight(64, 48, 300);
    sight.add(sphere_mesh(1, 20), turned({0, 0, 4}));
    ASSERT_TRUE(sight.place());
    VisibilityBuffer small(sight.geometry, {1, 1000, 100});
    const VisibilityBuffer::Shown shown{0, sight.poses[0], 1, sight.embree->mesh(0, 0)};
    EXPECT_FALSE(small.place(sight.camera, {&shown, 1}));
}

}  // namespace
}  // namespace hilcam
