// Objects at their levels of detail.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

// Whether an object has a mesh of its own or another's, the picture is the same, at every level of detail.
TEST(Renderer, AnObjectLikeAnotherLooksAsOneWithItsOwnMesh) {
    for (const double lod_error_px : {0.0, 1.0}) {
        Stage s;
        s.quality.lod_error_px = lod_error_px;
        SceneObject detailed = cube(lambert(0.5), s.grid);
        detailed.levels = {{sphere(8, lambert(0.5), s.grid).mesh, 0.05, {0}, {}}};
        s.add(plate(lambert(0.2), s.grid), {0, 0, 9});
        s.add(detailed, {-1, 0, 6}, {0.3, 0.4, 0});
        s.add(detailed, {1, 0.5, 5}, {1, 0, 2});
        s.render();
        const std::vector<float> own(s.radiance.all().begin(), s.radiance.all().end());
        s.scene.objects[2] = {"second", 1, {}, {}, {}};
        s.render();
        EXPECT_TRUE(std::equal(own.begin(), own.end(), s.radiance.all().begin())) << lod_error_px;
        s.world.objects[2].position_world_m.x += 0.1;
        s.render_again();
        EXPECT_FALSE(std::equal(own.begin(), own.end(), s.radiance.all().begin()));
    }
}

// Two balls far apart, the camera between them, a long way from either: the sphere that holds both is about it.
TEST(Renderer, ALevelIsChosenByWhatOfAnObjectIsNearest) {
    constexpr float kApart_m = 40;
    Stage s;
    const auto two_balls = [&](int rings) {
        SceneObject both = sphere(rings, lambert(0.5), s.grid), other = both;
        const auto count = static_cast<std::uint32_t>(both.mesh.vertices_m.size());
        for (const Vec3f& at : other.mesh.vertices_m)
            both.mesh.vertices_m.push_back(at + Vec3f{kApart_m, 0, 0});
        for (const auto& [a, b, c] : other.mesh.triangles)
            both.mesh.triangles.push_back({a + count, b + count, c + count});
        both.mesh.surface_of_triangle.assign(both.mesh.triangles.size(), 0);
        both.mesh.normals.insert(both.mesh.normals.end(), other.mesh.normals.begin(),
                                 other.mesh.normals.end());
        return both;
    };
    const SceneObject coarse = two_balls(6);
    SceneObject detailed = two_balls(12);
    detailed.levels = {{coarse.mesh, 0.05, {0}, {}}};
    const double distance_m = 10;  // of the nearer one
    const auto picture = [&](const SceneObject& object, double lod_error_px) {
        s.scene.objects.clear(), s.world.objects.clear();
        s.quality.lod_error_px = lod_error_px;
        s.add(object, {0, 0, distance_m});
        s.render();
        return std::vector<float>(s.radiance.all().begin(), s.radiance.all().end());
    };
    // The error is seen as 0.05 m at 9 m.
    const double error_px = 0.05 / (distance_m - 1) * s.geometry.focal_length_px;
    EXPECT_EQ(picture(detailed, 1.1 * error_px), picture(coarse, 0));
    EXPECT_EQ(picture(detailed, 0.8 * error_px), picture(two_balls(12), 0));
}

}  // namespace
}  // namespace hilcam
