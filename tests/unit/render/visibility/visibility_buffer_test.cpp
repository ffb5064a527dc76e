#include "render/visibility/visibility_buffer.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "render/brdf/microfacet.h"
#include "render/scene/surface.h"
#include "tests/support/vector_widths.h"

namespace hilcam {
namespace {

// A camera that looks along its +z, and what it sees by the buffer and by rays through the same samples.
struct BufferAndRays {
    ImageGeometry geometry;
    Pose camera;
    std::vector<Mesh> meshes;
    std::vector<Pose> poses;
    std::vector<std::vector<std::array<Vec3f, 2>>> boxes_m;
    bool with_boxes = false;
    std::unique_ptr<EmbreeScene> embree;
    std::unique_ptr<VisibilityBuffer> buffer;

    BufferAndRays(int width_px, int height_px, double focal_px) {
        geometry.width_px = width_px, geometry.height_px = height_px, geometry.guard_px = 3;
        geometry.focal_length_px = focal_px;
    }
    void add(Mesh mesh, const Pose& pose) {
        boxes_m.push_back(
            ObjectSurfaces(mesh, std::vector<Material>(mesh.surfaces.size()), nullptr).cluster_bounds_m);
        meshes.push_back(std::move(mesh)), poses.push_back(pose);
    }

    bool place() {
        std::vector<std::vector<const Mesh*>> levels;
        VisibilityBuffer::Capacity room{meshes.size(), 0, 0};
        for (const Mesh& mesh : meshes) {
            levels.push_back({&mesh});
            room.vertices += mesh.vertices_m.size(), room.triangles += mesh.triangles.size();
        }
        embree = std::make_unique<EmbreeScene>(levels, true);
        embree->place(poses, std::vector<std::size_t>(meshes.size()), camera.position_world_m);
        buffer = std::make_unique<VisibilityBuffer>(geometry, room);
        std::vector<VisibilityBuffer::Shown> shown;
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            double radius_m = 0;
            for (const Vec3f& v : meshes[i].vertices_m)
                radius_m = std::max(radius_m, static_cast<double>(length(v)));
            shown.push_back({static_cast<std::uint32_t>(i), poses[i], radius_m, embree->mesh(i, 0)});
            if (with_boxes) shown.back().cluster_bounds_m = boxes_m[i];
        }
        return buffer->place(camera, shown);
    }

    struct Count {
        int samples = 0, seen_by_both = 0, only_buffer = 0, only_rays = 0, other_triangle = 0;
    };
    // by_tile: rays through the lens as its tiles have it, else through the lens itself.
    Count compare(bool by_tile = false) const {
        Count count;
        const Mat3d world_from_camera = to_matrix(camera.world_from_body);
        VisibilityTile tile;
        for (int ty = 0; ty < geometry.padded_height(); ty += kVisibilityTile_px)
            for (int tx = 0; tx < geometry.padded_width(); tx += kVisibilityTile_px) {
                if (!buffer->fill(tx, ty, tile)) tile.clear();
                const int x1 = std::min(tx + kVisibilityTile_px, geometry.padded_width());
                const int y1 = std::min(ty + kVisibilityTile_px, geometry.padded_height());
                for (int y = ty; y < y1; ++y)
                    for (int x = tx; x < x1; ++x)
                        add_pixel(tile.ids(x - tx, y - ty), x, y, world_from_camera, by_tile, count);
            }
        return count;
    }

  private:
    void add_pixel(const std::uint32_t* ids, int x, int y, const Mat3d& world_from_camera, bool by_tile,
                   Count& count) const {
        RayPacket rays;
        HitPacket hits;
        rays.count = kVisibilitySamples;
        for (int i = 0; i < kVisibilitySamples; ++i) {
            const Vec3d dir =
                by_tile ? buffer->direction(x, y, {sample_x(i), sample_y(i)})
                        : world_from_camera * geometry.direction_camera(
                                                  x + static_cast<double>(sample_x(i)) - geometry.guard_px,
                                                  y + static_cast<double>(sample_y(i)) - geometry.guard_px);
            rays.set(i, {}, to_float(dir), 0, std::numeric_limits<float>::infinity());
        }
        embree->intersect(rays, Coherence::kIncoherent, hits);
        for (std::size_t i = 0; i < kVisibilitySamples; ++i) {
            ++count.samples;
            const bool by_rays = hits.object[i] != HitPacket::kMiss;
            const bool by_buffer = ids[i] != VisibilityTile::kNothing;
            if (by_rays && by_buffer) {
                ++count.seen_by_both;
                const VisibilityBuffer::Seen seen = buffer->seen(ids[i]);
                if (seen.triangle != hits.triangle[i] || seen.shown->object != hits.object[i])
                    ++count.other_triangle;
            } else if (by_rays) {
                ++count.only_rays;
            } else if (by_buffer) {
                ++count.only_buffer;
            }
        }
    }
};

Mesh sphere(float radius_m, int rings) {
    Mesh mesh;
    const int across = 2 * rings;
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j < across; ++j) {
            const float theta = static_cast<float>(i) * kPiF / static_cast<float>(rings);
            const float phi = static_cast<float>(j) * 2 * kPiF / static_cast<float>(across);
            mesh.vertices_m.push_back(radius_m * Vec3f{std::sin(theta) * std::cos(phi),
                                                       std::sin(theta) * std::sin(phi), std::cos(theta)});
        }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * across + j % across); };
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < across; ++j) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    mesh.surface_of_triangle.resize(mesh.triangles.size());
    return mesh;
}

// Triangles anywhere in a cube, of all sizes.
Mesh debris(int count, float size_m, unsigned seed) {
    Mesh mesh;
    std::mt19937 engine(seed);
    std::uniform_real_distribution<float> place(-size_m, size_m);
    for (int i = 0; i < count; ++i) {
        const Vec3f at{place(engine), place(engine), place(engine)};
        const float scale = std::exp2(-8.0f * std::abs(place(engine)) / size_m);
        for (int k = 0; k < 3; ++k)
            mesh.vertices_m.push_back(at + scale * Vec3f{place(engine), place(engine), place(engine)});
        const auto n = static_cast<std::uint32_t>(3 * i);
        mesh.triangles.push_back({n, n + 1, n + 2});
    }
    mesh.surface_of_triangle.resize(mesh.triangles.size());
    return mesh;
}

Pose turned(Vec3d position_m) { return {position_m, normalized(Quat{0.7, 0.2, -0.5, 0.3})}; }

// A sphere's triangles share all their edges: where it is seen, no sample is lost between two of them.
TEST(VisibilityBuffer, SeesWhatRaysSee) {
    BufferAndRays sight(200, 150, 300);
    sight.add(sphere(1, 100), turned({0.1, -0.05, 4}));
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

// A lens of a camera of 2000 px, with 5 % of barrel distortion in this corner of its picture and a little
// tangential.
void bend(BufferAndRays& sight) {
    sight.geometry.distortion.k1 = -0.25, sight.geometry.distortion.k2 = 0.1;
    sight.geometry.distortion.p1 = 1e-3, sight.geometry.distortion.p2 = -5e-4;
    sight.geometry.principal_offset_px = {-500, -300};
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
    sight.add(sphere(1, 200), turned({0.3, 0.1, 0.2}));
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
    sight.add(sphere(1, 200), turned({0.3, 0.1, 0.2}));
    ASSERT_TRUE(sight.place());
    const BufferAndRays::Count count = sight.compare();
    EXPECT_LE(count.samples - count.seen_by_both, 2);
}

// What all samples see.
std::vector<std::uint32_t> ids_of(const BufferAndRays& sight) {
    std::vector<std::uint32_t> ids;
    VisibilityTile tile;
    for (int y = 0; y < sight.geometry.padded_height(); y += kVisibilityTile_px)
        for (int x = 0; x < sight.geometry.padded_width(); x += kVisibilityTile_px) {
            if (!sight.buffer->fill(x, y, tile)) tile.clear();
            ids.insert(ids.end(), tile.id.begin(), tile.id.end());
        }
    return ids;
}

// Vectors of another width than this processor's are for other processors: their frames must be these.
TEST(VisibilityBuffer, SeesTheSameWithVectorsOfAnyWidth) {
    BufferAndRays sight(200, 150, 300);
    sight.add(debris(1501, 3, 5), turned({0, 0, 8}));
    sight.add(sphere(1, 50), turned({0.3, 0.1, 1.2}));
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
        sight.add(sphere(2, 60), turned(at)), sight.add(debris(4000, 3, 6), turned(at));
        ASSERT_TRUE(sight.place());
        const std::vector<std::uint32_t> all = ids_of(sight);
        sight.with_boxes = true;
        ASSERT_TRUE(sight.place());
        EXPECT_EQ(ids_of(sight), all) << at.x << " " << at.z;
    }
}

TEST(VisibilityBuffer, SaysWhenAFrameShowsMoreThanThereIsRoomFor) {
    BufferAndRays sight(64, 48, 300);
    sight.add(sphere(1, 20), turned({0, 0, 4}));
    ASSERT_TRUE(sight.place());
    VisibilityBuffer small(sight.geometry, {1, 1000, 100});
    const VisibilityBuffer::Shown shown{0, sight.poses[0], 1, sight.embree->mesh(0, 0)};
    EXPECT_FALSE(small.place(sight.camera, {&shown, 1}));
}

}  // namespace
}  // namespace hilcam
