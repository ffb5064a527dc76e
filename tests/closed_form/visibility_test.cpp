// Pictures out of the visibility buffer against pictures out of rays through the same places of each pixel: sixteen, or
// 64.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/levels/mesh_lod.h"
#include "tests/support/stage.h"
#include "tests/support/wavy_plate.h"

namespace hilcam {
namespace {

struct Difference {
    double mean = 0;      // of the pictures' means, as a fraction
    double greatest = 0;  // of a pixel, against the brightest
    double covered = 0;   // of the shares that objects cover
};
Difference difference_from_rays(Stage& s, int across = 4) {
    s.quality.rays_across = 0;  // small objects would ask for more
    s.quality.samples_per_axis = across;
    s.quality.buffer_samples = across * across;
    s.quality.visibility = "rays";
    s.render();
    const RadianceImage rays = std::move(s.radiance);
    const RenderStats by_rays = s.stats;
    s.radiance = RadianceImage(rays.width(), rays.height(), rays.planes());
    s.quality.samples_per_axis = 1;
    s.quality.visibility = "buffer";
    s.render();
    EXPECT_EQ(s.stats.primary_rays, 0u);
    Difference out;
    double sum_rays = 0, sum_buffer = 0, brightest = 0;
    for (int y = 0; y < rays.height(); ++y)
        for (int x = 0; x < rays.width(); ++x) {
            const double a = rays.row(y, 0)[static_cast<std::size_t>(x)];
            const double b = s.radiance.row(y, 0)[static_cast<std::size_t>(x)];
            sum_rays += a, sum_buffer += b, brightest = std::max(brightest, a);
            out.greatest = std::max(out.greatest, std::abs(a - b));
        }
    EXPECT_GT(brightest, 0);
    out.mean = sum_buffer / sum_rays - 1;
    out.greatest /= brightest;
    out.covered = s.stats.coverage - by_rays.coverage;
    return out;
}

// Flat faces that lie open: each has one radiance, and nothing is left but which sample sees which.
TEST(Visibility, ACubeIsWhatRaysSee) {
    Stage s;
    s.quality.path_model = "direct";
    s.sun({0.3, 0.5, -1});
    s.add(cube(lambert(0.5), s.grid), {0.2, -0.1, 3}, {0.4, 0.7, -0.2});
    const Difference d = difference_from_rays(s);
    EXPECT_NEAR(d.covered, 0, 1e-6);
    EXPECT_LT(std::abs(d.mean), 1e-6);
    EXPECT_LT(d.greatest, 1e-5);
}

// Bars of 0.02 to 0.15 px about a middle, in all directions.
SceneObject bars(const SpectralGrid& grid) {
    std::vector<Vec3f> corners;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    constexpr int kBars = 16;
    for (int i = 0; i < kBars; ++i) {
        const double angle_rad = 2 * kPi * (i + 0.3) / kBars, half_px = 0.01 + 0.065 * i / (kBars - 1);
        const Vec3d along{std::cos(angle_rad), std::sin(angle_rad), 0}, across{-along.y, along.x, 0};
        const auto first = static_cast<std::uint32_t>(corners.size());
        for (const Vec2d at :
             {Vec2d{4, -half_px}, Vec2d{18, -half_px}, Vec2d{18, half_px}, Vec2d{4, half_px}})
            corners.push_back(to_float(0.125 * (at.x * along + at.y * across)));
        triangles.push_back({first, first + 1, first + 2});
        triangles.push_back({first, first + 2, first + 3});
    }
    return object_of(std::move(corners), std::move(triangles), lambert(0.5), grid);
}

// Each pixel has what its 64 samples see of them.
TEST(Visibility, ThinBarsAreWhatRaysSee) {
    Stage s;
    s.quality.path_model = "direct";
    s.sun({0.3, 0.5, -1});
    s.add(bars(s.grid), {0, 0, 4});
    const Difference d = difference_from_rays(s, 8);
    EXPECT_NEAR(d.covered, 0, 1e-6);
    EXPECT_LT(std::abs(d.mean), 1e-5);
    EXPECT_LT(d.greatest, 1e-4);
    const std::span<const float> pixels = s.radiance.plane(0);
    EXPECT_GT(std::count_if(pixels.begin(), pixels.end(), [](float value) { return value > 0; }), 200);
}

// What is far against its size keeps its digits.
TEST(Visibility, ACubeIsWhatRaysSeeFromATenThousandTimesItsSize) {
    Stage s;
    s.quality.path_model = "direct";
    s.geometry.focal_length_px = 32e4;
    s.sun({0.3, 0.5, -1});
    s.add(cube(lambert(0.5), s.grid), {0.2, -0.1, 3e4}, {0.4, 0.7, -0.2});
    const Difference d = difference_from_rays(s);
    EXPECT_NEAR(d.covered, 0, 1e-4);
    EXPECT_LT(std::abs(d.mean), 1e-3);
    EXPECT_LT(d.greatest, 0.13);  // two samples of an edge
}

// Facets of one material that lean otherwise.
TEST(Visibility, ASphereIsWhatRaysSee) {
    for (const std::size_t model : {kModel<brdf::Lambert>, kModel<brdf::Metal>}) {
        Stage s;
        s.quality.path_model = "direct";
        s.sun({0.8, 0.3, -1});
        MaterialConfig material = lambert(0.5);
        material.model = model;
        material.roughness = 0.5;
        s.geometry.focal_length_px = 320;  // a vertex has one direction to the viewer
        s.add(sphere(200, material, s.grid), {0, 0, 30});
        const Difference d = difference_from_rays(s);
        EXPECT_NEAR(d.covered, 0, 1e-4);
        EXPECT_LT(std::abs(d.mean), 2e-3);
        EXPECT_LT(d.greatest, 0.02);
    }
}

// The rim of the Earth and what stands before it.
TEST(Visibility, TheEarthBehindACubeIsWhatRaysSee) {
    Stage s;
    s.quality.path_model = "direct";
    s.earth(0.3);
    s.world.bodies[BodyId::kEarth].world_m = {9e6, 0, 3e7};
    s.sun({0.3, 0.5, -1});
    s.add(cube(lambert(0.5), s.grid), {0.2, -0.1, 3}, {0.4, 0.7, -0.2});
    const Difference d = difference_from_rays(s);
    EXPECT_LT(std::abs(d.mean), 1e-3);
    EXPECT_LT(d.greatest, 0.02);
}

// The same scene by rays, in a picture of twice as many pixels through the same places: which half has how much, of a
// cube before the Earth by sixteen samples and of bars by 64.
void expect_halves_as_by_rays(int across) {
    const auto stage = [&] {
        Stage s;
        s.quality.path_model = "direct";
        s.quality.rays_across = 0;
        s.sun({0.3, 0.5, -1});
        if (across == 8) {
            s.add(bars(s.grid), {0, 0, 4});
            return s;
        }
        s.earth(0.3);
        s.world.bodies[BodyId::kEarth].world_m = {9e6, 0, 3e7};
        s.add(cube(lambert(0.5), s.grid), {0.2, -0.1, 3}, {0.4, 0.7, -0.2});
        return s;
    };
    Stage fine = stage();
    fine.geometry = {64, 64, 8, 64, {}};
    fine.radiance = RadianceImage(80, 80, 2);
    fine.quality.samples_per_axis = across / 2;
    fine.quality.visibility = "rays";
    fine.render();
    Stage s = stage();
    s.quality.visibility = "buffer";
    s.quality.buffer_samples = across * across;
    s.radiance.keep_halves({Spectrum{{1}}, Spectrum{{0, 2}}});
    s.render();
    const HalfLight& halves = *s.radiance.halves();
    ASSERT_TRUE(halves.used());
    double brightest = 0, uneven = 0;
    for (const float value : fine.radiance.plane(0))
        brightest = std::max(brightest, static_cast<double>(value));
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x)
            for (const int channel : {0, 1}) {
                const auto part = [&](int right, int down) {
                    return (channel + 1) / 4.0 *
                           static_cast<double>(fine.radiance.row(
                               2 * y + down, channel)[static_cast<std::size_t>(2 * x + right)]);
                };
                const double a = part(0, 0), b = part(1, 0), c = part(0, 1), d = part(1, 1);
                const double expected[] = {b + d - a - c, c + d - a - b, a + d - b - c};
                for (const int i : {0, 1, 2}) {
                    const double found =
                        halves.unknown(x, y) ||
                                halves.kinds(y)[static_cast<std::size_t>(x)] == HalfKind::kSmooth
                            ? 0
                            : static_cast<double>(halves.row(y, i, channel)[static_cast<std::size_t>(x)]);
                    // One sample may see the other of two, and within the disk a pixel has one ray.
                    ASSERT_NEAR(found, expected[i], (channel + 1) * 0.02 * brightest)
                        << x << ' ' << y << ' ' << i;
                    uneven = std::max(uneven, std::abs(found));
                }
            }
    EXPECT_GT(uneven, 0.5 * brightest);
}
TEST(Visibility, HalvesAreWhatRaysSeeInPicturesOfTwiceThePixels) {
    expect_halves_as_by_rays(4);
    expect_halves_as_by_rays(8);
}

// With kept light four pixels share what changes slowly.
TEST(Visibility, KeptLightIsWhatRaysSee) {
    Stage s;
    s.quality.path_model = "kept";
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
    s.quality.path_model = "kept";
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

// A plate of 2 m whose waves are 0.2 steep.
SceneObject foil(const MaterialConfig& material, const SpectralGrid& grid) {
    Mesh mesh = wavy_plate(200, -1, 1, 3e-3);
    return object_of(std::move(mesh.vertices_m), std::move(mesh.triangles), material, grid);
}
double sum_of(const RadianceImage& radiance) {
    double sum = 0;
    for (int y = 0; y < radiance.height(); ++y)
        for (const float value : radiance.row(y, 0)) sum += static_cast<double>(value);
    return sum;
}

// Some hundred triangles instead of 80,000.
TEST(Visibility, LevelsOfDetailKeepTheLightOfWrinkles) {
    MaterialConfig metal = lambert(0.9);
    metal.model = kModel<brdf::Metal>;
    metal.roughness = 0.4;
    for (const MaterialConfig& material : {lambert(0.5), metal}) {
        // Four normals and their scatter are all that is kept of each triangle's waves.
        const double within = material.model == kModel<brdf::Metal> ? 0.05 : 0.005;
        for (const Vec3d& sun : {Vec3d{0.3, 0.2, -1}, Vec3d{1, 0.3, -0.5}})
            for (const char* visibility : {"rays", "buffer"}) {
                Stage s;
                s.quality.path_model = "direct";
                s.quality.visibility = visibility;
                s.quality.rays_across = 0;
                s.quality.samples_per_axis = 4;
                s.geometry.focal_length_px = 160;
                s.sun(sun);
                SceneObject object = foil(material, s.grid);
                object.levels = coarser_levels(object.mesh);
                ASSERT_LT(object.levels.back().mesh.triangles.size(), 3000u);
                s.add(object, {0, 0, 15}, {kPi - 0.3, 0.2, 0});
                s.quality.lod_error_px = 0;
                s.render();
                const double mesh = sum_of(s.radiance);
                s.quality.lod_error_px = 16;
                s.render();
                EXPECT_NEAR(sum_of(s.radiance) / mesh, 1, within) << visibility << " " << sun.x;
            }
    }
}

// The Sun stands 4 and 2 degrees above a plate whose waves are up to 14 steep. Without their shadows on each other a
// level has 15 and 40 % too much light.
TEST(Visibility, LevelsOfDetailKeepTheShadowsOfWrinkles) {
    MaterialConfig metal = lambert(0.9);
    metal.model = kModel<brdf::Metal>;
    metal.roughness = 0.4;
    struct Low {
        double up, within;
    };
    for (const MaterialConfig& material : {lambert(0.5), metal})
        for (const Low low : {Low{0.15, 0.04}, Low{0.1, 0.07}}) {
            Stage s;
            s.quality.path_model = "direct";
            s.quality.rays_across = 0;
            s.quality.samples_per_axis = 4;
            s.geometry.focal_length_px = 160;
            s.sun({1, 0.3, -low.up});
            SceneObject object = foil(material, s.grid);
            object.levels = coarser_levels(object.mesh);
            s.add(object, {0, 0, 15}, {kPi - 0.3, 0.2, 0});
            s.quality.visibility = "rays";
            s.quality.lod_error_px = 0;
            s.render();
            const double mesh = sum_of(s.radiance);
            s.quality.lod_error_px = 16;
            for (const char* visibility : {"rays", "buffer"}) {
                s.quality.visibility = visibility;
                s.render();
                EXPECT_NEAR(sum_of(s.radiance) / mesh, 1, low.within) << visibility << " " << low.up;
            }
        }
}

// A frame with more triangles than there is room for, or no room at all, is for rays: terrain, lenses that
// bend lines.
TEST(Visibility, ALensThatBendsLinesIsForRays) {
    Stage s;
    s.quality.path_model = "direct";
    s.quality.visibility = "buffer";
    s.geometry.distortion.k1 = 0.1;
    s.add(cube(lambert(0.5), s.grid), {0, 0, 3});
    s.render();
    EXPECT_GT(s.stats.primary_rays, 0u);
}

class ShadowsEdge : public testing::TestWithParam<const char*> {};
// A plate a quarter of a metre above a floor, the Sun at 45 degrees: along the shadow's edge the floor has the light
// of that part of the disk which stands past the plate. Seen by sixteen samples with a ray each to the Sun's
// middle it would be none or all.
TEST_P(ShadowsEdge, IsAsWideAsTheSun) {
    constexpr double kAbove_m = 0.25, kPixel_m = 1.25e-3, kSunRadius_rad = 6.957e8 / kAstronomicalUnit_m;
    Stage s;
    s.quality.path_model = GetParam();
    s.quality.visibility = "buffer";
    s.quality.sun_disk = false;
    s.quality.rays_across = 0;
    s.geometry.focal_length_px = 4 / kPixel_m;
    s.sun({1, 0, -1});
    s.add(plate(lambert(0.5), s.grid), {0, 0, 4});
    s.add(plate(lambert(0.5), s.grid), {1 + kAbove_m, 0, 4 - kAbove_m});
    s.render();
    const double lit = 0.5 / kPi * static_cast<double>(kSun_w_m2_um) * std::sqrt(0.5);
    // The share of a disk of radius 1 past an edge that is so far from its middle.
    const auto past = [](double d) {
        d = std::clamp(d, -1.0, 1.0);
        return 0.5 + (std::asin(d) + d * std::sqrt(1 - d * d)) / kPi;
    };
    const int middle = s.radiance.width() / 2;
    for (int x = 0; x < s.radiance.width(); ++x) {
        double mean = 0, expected = 0;
        for (int y = middle - 8; y < middle + 8; ++y)
            mean += static_cast<double>(s.radiance.row(y, 0)[static_cast<std::size_t>(x)]) / 16;
        // A way along the floor turns the direction to the plate's edge by half of it over the height.
        for (int i = 0; i < 8; ++i) {
            const double off_m = -kPixel_m * (x - middle + (i + 0.5) / 8);
            expected += past(off_m / (2 * kAbove_m) / kSunRadius_rad) / 8;
        }
        EXPECT_NEAR(mean / lit, expected, 0.07) << x;
    }
}
INSTANTIATE_TEST_SUITE_P(ByModel, ShadowsEdge, testing::Values("direct", "kept"));

// Pixels far smaller than the places that keep light.
class NearBy : public testing::Test {
  protected:
    Stage s;
    NearBy() {
        s.quality.path_model = "kept";
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
