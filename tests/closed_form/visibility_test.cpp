// Pictures out of the visibility buffer against pictures out of rays through the same places of each pixel: sixteen, or
// 64.

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

// The triangles of a strip three hundred times longer than wide do not shadow themselves, in whatever direction it points: the
// buffer's shading points are nearer to their plane than the height at which shadow rays start.
TEST(Visibility, LongTrianglesAreNotInTheirOwnShadow) {
    for (int i = 0; i < 12; ++i) {
        Stage s;
        s.quality.path_model = "direct";
        s.camera(64, 0.2);
        s.sun({0.3, 0.5, -1});
        s.add(object_of({{-3, -0.01f, 0}, {3, -0.01f, 0}, {3, 0.01f, 0}, {-3, 0.01f, 0}},
                        {{0, 1, 2}, {0, 2, 3}}, lambert(0.5), s.grid),
              {0.1, -0.2, 14}, {0.1 * i, 0.3, 0.25 * i});
        const Difference d = difference_from_rays(s, 8);
        EXPECT_LT(std::abs(d.mean), 3e-3) << i;
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
void expect_moments_as_by_rays(int across) {
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
    s.radiance.keep_moments({Spectrum{{1}}, Spectrum{{0, 2}}});
    s.render();
    const SubpixelLight& moments = *s.radiance.moments();
    ASSERT_TRUE(moments.used());
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
                        moments.unknown(x, y) ||
                                moments.kinds(y)[static_cast<std::size_t>(x)] == SubpixelKind::kSmooth
                            ? 0
                            : static_cast<double>(moments.row(y, i, channel)[static_cast<std::size_t>(x)]);
                    // One sample may see the other of two, and within the disk a pixel has one ray.
                    ASSERT_NEAR(found, expected[i], (channel + 1) * 0.02 * brightest)
                        << x << ' ' << y << ' ' << i;
                    uneven = std::max(uneven, std::abs(found));
                }
            }
    EXPECT_GT(uneven, 0.5 * brightest);
}
TEST(Visibility, HalvesAreWhatRaysSeeInPicturesOfTwiceThePixels) {
    expect_moments_as_by_rays(4);
    expect_moments_as_by_rays(8);
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

}  // namespace
}  // namespace hilcam
