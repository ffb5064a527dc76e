// Cached light, mirrors and lamps out of the visibility buffer, where pixels share it, against pictures out of rays.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "tests/support/difference_from_rays.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

// Four neighbouring pixels share cached light, as it changes slowly.
TEST(Visibility, CachedLightIsWhatRaysSee) {
    Stage s;
    s.quality.path_model = "cached";
    s.sun({0.3, -0.5, -1});
    const std::vector<Vec3f> corner = {{-1, -1, 0}, {1, -1, 0},  {1, 1, 0},
                                       {-1, 1, 0},  {-1, 1, -2}, {1, 1, -2}};
    s.add(object_of(corner, {{0, 1, 2}, {0, 2, 3}, {3, 2, 5}, {3, 5, 4}}, lambert(0.8), s.grid), {0, 0, 4},
          {0, 0.2, 0});
    const Difference d = difference_from_rays(s);
    EXPECT_LT(std::abs(d.mean), 1e-3);
    EXPECT_LT(d.greatest, 0.05);
}

MaterialConfig rough_metal(double roughness) {
    MaterialConfig out = lambert(0.8);
    out.model = kModel<brdf::Metal>;
    out.roughness = roughness;
    return out;
}
// The Sun is behind the camera.
void keep_light_of_earth_at(Vec3d earth_m, Stage& s) {
    s.quality.path_model = "cached";
    s.earth(0.3);
    s.world.bodies[BodyId::kEarth].world_m = earth_m;
    s.sun({0, 0.2, 1});
}

// Four pixels share what a mirror has of the Earth's light by the tails of its lobe, where it shows none of the Earth; the
// mirrored Earth ends in the picture.
TEST(Visibility, AMirrorBesideTheEarthIsWhatRaysSee) {
    Stage s;
    keep_light_of_earth_at({0, 0, -6.7875e6}, s);
    const MaterialConfig metal = rough_metal(0.15);
    s.add(plate(metal, s.grid), {0, 0, 4}, {kPi + 36 * kDegree_rad, 0, 0});
    const Difference d = difference_from_rays(s);
    EXPECT_LT(std::abs(d.mean), 1e-3);
    EXPECT_LT(d.greatest, 0.02);
}

// Metal in folds narrower than a pixel, whose sides lean by 8 degrees each: what a pixel has of the Earth, beside the mirror's
// direction, is what both sides show of it. By the normals' mean 36 % of it would be missing, by one side up to 77 %.
TEST(Visibility, FoldsShowTheEarthAsTheyLeanTogether) {
    constexpr int kFolds = 23;  // over 16 pixels, so that each pixel has other parts of them
    Stage s;
    keep_light_of_earth_at({0, 3e7, -3e7}, s);
    const MaterialConfig metal = rough_metal(0.45);
    std::vector<Vec3f> v;
    std::vector<std::array<std::uint32_t, 3>> t;
    const float step_m = 1.0f / kFolds, height_m = step_m * static_cast<float>(std::tan(8 * kDegree_rad));
    for (int i = 0; i <= 2 * kFolds; ++i)
        for (const float x : {-1.0f, 1.0f})
            v.push_back({x, -1 + step_m * static_cast<float>(i), i % 2 == 0 ? 0.0f : height_m});
    for (std::uint32_t i = 0; i < 4 * kFolds; i += 2)
        t.push_back({i, i + 1, i + 2}), t.push_back({i + 1, i + 3, i + 2});
    s.add(object_of(v, t, metal, s.grid), {0, 0, 4});
    const Difference d = difference_from_rays(s);
    EXPECT_LT(std::abs(d.mean), 0.02);
    EXPECT_LT(d.greatest, 0.05);
}

// Pixels far smaller than the places that keep light.
class NearBy : public testing::Test {
  protected:
    Stage s;
    NearBy() {
        s.quality.path_model = "cached";
        s.geometry.focal_length_px = 2000;
    }
    // A pixel at an edge, of which the place in its middle tells, is off by half of it at most.
    void expect_edges_as_by_rays() {
        const Difference d = difference_from_rays(s);
        EXPECT_LT(std::abs(d.mean), 0.01);
        EXPECT_LT(d.greatest, 0.6);
        const std::span<const float> pixels = s.radiance.plane(0);
        const float brightest = *std::max_element(pixels.begin(), pixels.end());
        for (const float part : {0.0f, 0.8f})
            EXPECT_GT(std::count_if(
                          pixels.begin(), pixels.end(),
                          [&](float p) { return p >= part * brightest && p <= (part + 0.2f) * brightest; }),
                      400);
    }
};

// A mirror at 30 degrees, and past it, in the Sun, a plate that ends in the middle of what it shows.
TEST_F(NearBy, AMirrorShowsEdgesAsRaysDo) {
    MaterialConfig mirror = lambert(0.8);
    mirror.model = kModel<brdf::Metal>;
    mirror.roughness = 0.05;
    s.sun({-0.3, 1, 0.5});
    s.add(plate(mirror, s.grid), {0, 0, 4}, {0, 150 * kDegree_rad, 0});
    s.add(plate(lambert(0.5), s.grid), {0.866, 1.003, 3.5}, {0, -60 * kDegree_rad, 0.05});
    expect_edges_as_by_rays();
}

// The plate above lies in a lamp's light, and its shadow ends in the middle of the picture.
TEST_F(NearBy, ALampsShadowHasEdgesAsByRays) {
    s.scene.sun_irradiance_1au_w_m2_um = {};
    Spectrum intensity;
    intensity.bin.fill(1);
    s.scene.lamps.push_back({"lamp", 0, intensity, {}});
    s.world.lamps.resize(1);
    s.world.lamps[0] = {{2.0034, 0, 2}, {0, 0, 1}, 1};
    s.add(plate(lambert(0.5), s.grid), {0, 0, 4});
    s.add(plate(lambert(0.5), s.grid), {2, 0, 3}, {kPi * std::cos(0.05), kPi * std::sin(0.05), 0});
    expect_edges_as_by_rays();
}

}  // namespace
}  // namespace hilcam
