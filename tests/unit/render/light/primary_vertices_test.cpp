#include "render/light/primary_vertices.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

// A tube of rough metal along y, a pixel and a half wide, of twelve smooth sides. Its sunlight at ten places in its pixel.
std::array<double, 10> light_of_tube(const std::string& visibility, int samples_per_axis) {
    Stage s;
    s.quality.visibility = visibility;
    s.quality.buffer_samples = 64;
    s.quality.samples_per_axis = samples_per_axis;
    s.quality.max_depth = 1;
    s.camera(16, 0.016);
    s.sun({1, 0.1, -1});
    constexpr double kPixel_m = 5 * 2 * 0.016 / 16;
    constexpr std::uint32_t kSides = 12;
    MaterialConfig metal;
    metal.model = kModel<brdf::Metal>;
    metal.reflectance = Curve::constant(0.9);
    metal.roughness = 0.45;
    std::vector<Vec3f> normals, vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t i = 0; i < kSides; ++i) {
        const double around = 2 * kPi * i / kSides;
        const Vec3d out{std::cos(around), 0, std::sin(around)};
        for (const double y : {-1.0, 1.0}) {
            normals.push_back(to_float(out));
            vertices.push_back(to_float(0.75 * kPixel_m * out + Vec3d{0, y, 0}));
        }
        const std::uint32_t here = 2 * i, next = 2 * ((i + 1) % kSides);
        triangles.push_back({here, here + 1, next});
        triangles.push_back({next, here + 1, next + 1});
    }
    SceneObject tube = object_of(vertices, triangles, metal, s.grid);
    tube.mesh.normals = normals;
    s.add(std::move(tube), {0, 0, 5}, {0, 0, 0});
    s.build();
    std::array<double, 10> light{};
    for (std::size_t i = 0; i < light.size(); ++i) {
        s.world.objects[0].position_world_m.x = 0.1 * static_cast<double>(i) * kPixel_m;
        s.render_again();
        light[i] = s.light().irradiance;
    }
    return light;
}

// Its normals turn by thirty degrees in each of its sides, which a few samples see, and its highlight is twelve wide.
TEST(PrimaryVertices, AGlintOnAThinTubeStaysAsItMoves) {
    const std::array<double, 10> by_rays = light_of_tube("rays", 16), seen = light_of_tube("buffer", 1);
    for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_NEAR(seen[i] / by_rays[i], 1, 0.02) << i;
}

}  // namespace
}  // namespace hilcam
