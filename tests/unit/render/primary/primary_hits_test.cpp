#include "render/primary/primary_hits.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
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
    std::vector<Vec3f> normals, points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t i = 0; i < kSides; ++i) {
        const double around = 2 * kPi * i / kSides;
        const Vec3d out{std::cos(around), 0, std::sin(around)};
        for (const double y : {-1.0, 1.0}) {
            normals.push_back(to_float(out));
            points.push_back(to_float(0.75 * kPixel_m * out + Vec3d{0, y, 0}));
        }
        const std::uint32_t here = 2 * i, next = 2 * ((i + 1) % kSides);
        triangles.push_back({here, here + 1, next});
        triangles.push_back({next, here + 1, next + 1});
    }
    SceneObject tube = object_of(points, triangles, metal, s.grid);
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
TEST(PrimaryHits, AGlintOnAThinTubeStaysAsItMoves) {
    const std::array<double, 10> by_rays = light_of_tube("rays", 16), seen = light_of_tube("buffer", 1);
    for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_NEAR(seen[i] / by_rays[i], 1, 0.02) << i;
}

// A white wall that fills a picture of so many pixels with a texture of columns, each of which is lit as `shade` says of 0 to 1 across
// the picture; of so many strips. Its pixels' radiance in the middle row.
std::vector<double> light_of_wall(const std::string& visibility, int samples_per_axis, int strips,
                                  int columns, const std::function<double(double)>& shade) {
    constexpr int kWidth_px = 24;
    constexpr double kHalf_rad = 0.024, kDistance_m = 5;
    Stage s;
    s.quality.visibility = visibility;
    s.quality.buffer_samples = 64;
    s.quality.samples_per_axis = samples_per_axis;
    s.quality.max_depth = 1;
    s.quality.rays_across = 0;
    s.camera(kWidth_px, kHalf_rad);
    std::vector<Vec3f> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Vec2f> uvs;
    const auto half_m = static_cast<float>(kDistance_m * kHalf_rad);
    for (int i = 0; i < strips; ++i) {
        const auto first = static_cast<std::uint32_t>(points.size());
        for (const int side : {i, i + 1})
            for (const float y : {-2 * half_m, 2 * half_m}) {
                const float across = static_cast<float>(side) / static_cast<float>(strips);
                points.push_back({(2 * across - 1) * half_m, y, 0});
                uvs.push_back({across, y / (2 * half_m)});  // as dense down as across
            }
        triangles.push_back({first, first + 1, first + 2});
        triangles.push_back({first + 2, first + 1, first + 3});
    }
    SceneObject wall = object_of(points, triangles, lambert(1), s.grid);
    Texture texture;
    texture.width = columns, texture.height = 1;
    for (int x = 0; x < columns; ++x) {
        const auto c = static_cast<std::uint8_t>(std::lround(255 * shade((x + 0.5) / columns)));
        texture.texels.push_back({c, c, c});
    }
    wall.mesh.textures = {texture};
    wall.mesh.uvs = uvs;
    wall.materials[0].texture = 0;
    s.add(std::move(wall), {0, 0, kDistance_m}, {0, 0, 0});
    s.render();
    const auto row = s.radiance.row(kWidth_px / 2);
    return {row.begin() + 2, row.begin() + kWidth_px - 2};
}

// Bars three pixels apart: a pixel's width leaves 0.83 of them, and one look as wide left half of that.
TEST(PrimaryHits, ATextureIsAsSharpAsAPixel) {
    const auto bars = [](double across) { return 0.5 + 0.5 * std::sin(2 * kPi * 8 * across); };
    const auto swing = [](const std::vector<double>& light) {
        double sum = 0, squares = 0;
        for (const double v : light) sum += v;
        const double mean = sum / static_cast<double>(light.size());
        for (const double v : light) squares += (v / mean - 1) * (v / mean - 1);
        return std::sqrt(squares / static_cast<double>(light.size()));
    };
    const double by_rays = swing(light_of_wall("rays", 16, 1, 1024, bars));
    EXPECT_NEAR(swing(light_of_wall("buffer", 1, 1, 1024, bars)) / by_rays, 1, 0.08);
}

// Eight triangles in a pixel, of which a shading point is that which most samples see.
TEST(PrimaryHits, ATextureIsThatOfAllThatAPixelSees) {
    const auto quarter = [](double across) { return std::fmod(96 * across, 4) < 1 ? 1.0 : 0.0; };
    const std::vector<double> by_rays = light_of_wall("rays", 16, 96, 4608, quarter),
                              seen = light_of_wall("buffer", 1, 96, 4608, quarter);
    for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_NEAR(seen[i] / by_rays[i], 1, 0.02) << i;
}

}  // namespace
}  // namespace hilcam
