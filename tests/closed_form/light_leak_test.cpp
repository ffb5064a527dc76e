// Cached light in meshes as they should not be: a room without a window, in full sunlight, seen from inside. There
// is no light, whatever is wrong with its walls.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/support/split_triangles.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

constexpr float kWallAlbedo = 0.8f;
// Half the noise of an inspection camera in the dark (13 e- of reading) where sunlit paint gives 10,000 e-.
constexpr double kDark = 0.5 * 13 / 1e4;

SceneObject dark_room(const SpectralGrid& grid) { return cube(lambert(kWallAlbedo), grid, 2); }

// Each triangle in four, so many times, and each with corners of its own.
void split_into_islands(Mesh& mesh, int times) {
    split_triangles(mesh, times);
    const std::vector<Vec3f> corners = mesh.vertices_m;
    mesh.vertices_m.clear();
    for (auto& triangle : mesh.triangles)
        for (std::uint32_t& corner : triangle) {
            mesh.vertices_m.push_back(corners[corner]);
            corner = static_cast<std::uint32_t>(mesh.vertices_m.size() - 1);
        }
    mesh.surface_of_triangle.resize(mesh.triangles.size());
}
void add(Mesh& mesh, const Mesh& other, Vec3f at_m) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
    for (const Vec3f& v : other.vertices_m) mesh.vertices_m.push_back(v + at_m);
    for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
    mesh.surface_of_triangle.resize(mesh.triangles.size());
}

// The brightest pixel inside, of sunlit white paint.
double brightest_inside(const std::function<void(Mesh&)>& change) {
    Stage s;
    s.quality.path_model = "cached";
    s.quality.max_depth = 6;
    s.quality.visibility = "buffer";
    s.sun({0.4, 0.7, -1});
    SceneObject object = dark_room(s.grid);
    change(object.mesh);
    s.add(std::move(object), {0, 0, 0.2}, {0.3, 0.2, 0.1});
    s.render();
    double most = 0;
    for (const float value : s.radiance.plane(0)) most = std::max(most, static_cast<double>(value));
    const double sunlit = static_cast<double>(kSun_w_m2_um) * static_cast<double>(kWallAlbedo) / kPi;
    return most / sunlit;
}

TEST(LightLeak, AGoodRoomIsDark) {
    EXPECT_LT(brightest_inside([](Mesh&) {}), kDark);
}

// The test sees light where there is some: a wall is missing.
TEST(LightLeak, AnOpenRoomIsNot) {
    EXPECT_GT(brightest_inside([](Mesh& mesh) {
                  mesh.triangles.resize(mesh.triangles.size() - 4);
                  mesh.surface_of_triangle.resize(mesh.triangles.size());
              }),
              100 * kDark);
}

TEST(LightLeak, NoneWhereNormalsPointInwards) {
    EXPECT_LT(brightest_inside([](Mesh& mesh) {
                  for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
              }),
              kDark);
    EXPECT_LT(brightest_inside([](Mesh& mesh) {
                  for (std::size_t i = 0; i < mesh.triangles.size(); i += 2)
                      std::swap(mesh.triangles[i][0], mesh.triangles[i][1]);
              }),
              kDark);
}

TEST(LightLeak, NoneThroughFiftyThousandIslands) {
    EXPECT_LT(brightest_inside([](Mesh& mesh) { split_into_islands(mesh, 6); }), kDark);
}

TEST(LightLeak, NoneThroughWallsTwice) {
    EXPECT_LT(brightest_inside([](Mesh& mesh) {
                  const Mesh once = mesh;
                  add(mesh, once, {});
              }),
              kDark);
}

// A block that stands in the wall: half of its corners lie outside, in the Sun, and its sides pass through.
TEST(LightLeak, NoneAlongABlockThroughTheWall) {
    EXPECT_LT(
        brightest_inside([](Mesh& mesh) {
            add(mesh, cube(lambert(kWallAlbedo), SpectralGrid({0.5, 0.6, 0.7}), 0.4f).mesh, {0.1f, 0.2f, 1});
            add(mesh, cube(lambert(kWallAlbedo), SpectralGrid({0.5, 0.6, 0.7}), 0.3f).mesh, {-1, 0.3f, 0.2f});
        }),
        kDark);
}

// Walls that do not meet at the edges, by half a millimetre: no more comes in than random paths have, as a mean. (Less does:
// strips of sunlight narrower than a pixel are found by few samples.)
TEST(LightLeak, CracksLetInNoMoreThanTheyShould) {
    const auto open_edges = [](Mesh& mesh) {
        split_into_islands(mesh, 0);
        for (std::size_t i = 0; i < mesh.triangles.size(); i += 2) {
            // Two triangles a wall; both shrink towards their common middle.
            Vec3f middle{};
            for (const std::size_t k : {i, i + 1})
                for (const std::uint32_t corner : mesh.triangles[k])
                    middle = middle + (1.0f / 6) * mesh.vertices_m[corner];
            for (const std::size_t k : {i, i + 1})
                for (const std::uint32_t corner : mesh.triangles[k])
                    mesh.vertices_m[corner] = middle + 0.9995f * (mesh.vertices_m[corner] - middle);
        }
    };
    const auto share_lit = [&](const char* model) {
        Stage s;
        s.quality.path_model = model;
        s.quality.max_depth = 6;
        s.quality.samples_per_axis = model[0] == 'k' ? 1 : 16;
        s.quality.visibility = model[0] == 'k' ? "buffer" : "rays";
        s.sun({0.4, 0.7, -1});
        SceneObject object = dark_room(s.grid);
        open_edges(object.mesh);
        s.add(std::move(object), {0, 0, 0.2}, {0.3, 0.2, 0.1});
        s.render();
        return s.mean() / (static_cast<double>(kSun_w_m2_um) * static_cast<double>(kWallAlbedo) / kPi);
    };
    EXPECT_LT(share_lit("cached"), share_lit("path") + kDark);
}

// A wall that stands on the floor, somewhere in the cubes that light is cached in. On the side of the Sun the floor has the
// wall's light, on the other there is none: next to the wall, where its cubes are those of both sides, there is none either.
TEST(LightLeak, NoneBelowAWallOnTheFloor) {
    constexpr float kWall_m = 0.04f, kHigh_m = 0.5f;
    constexpr double kShown_m = 0.8;  // half of what the picture shows
    constexpr std::size_t kSize_px = 64;
    Stage s;
    s.quality.path_model = "cached";
    s.quality.visibility = "buffer";
    s.quality.rays_across = 0;  // the floor as the picture's pixels see it
    s.camera(kSize_px, 2 * std::atan(kShown_m / 4));
    const SceneObject wall =
        object_of({{kWall_m, -1, 0}, {kWall_m, 1, 0}, {kWall_m, 1, kHigh_m}, {kWall_m, -1, kHigh_m}},
                  {{0, 1, 2}, {0, 2, 3}}, lambert(kWallAlbedo), s.grid);
    s.add(joined(plate(lambert(kWallAlbedo), s.grid), wall), {0, 0, 4});
    s.sun({-1, 0, -0.2});
    s.render();
    const double sunlit = static_cast<double>(kSun_w_m2_um) * static_cast<double>(kWallAlbedo) / kPi;
    double before = 0, behind = 0;
    for (std::size_t i = 0; i < kSize_px * kSize_px; ++i) {
        const double x_m = (2 * (static_cast<double>(i % kSize_px) + 0.5) / kSize_px - 1) * kShown_m;
        const double light = static_cast<double>(s.radiance.plane(0)[i]) / sunlit;
        if (x_m < 0) before = std::max(before, light);
        // The camera sees the floor from here on: the wall hides its foot.
        if (x_m > 0.1) behind = std::max(behind, light);
    }
    EXPECT_GT(before, 100 * kDark);
    EXPECT_LT(behind, kDark);
}

}  // namespace
}  // namespace hilcam
