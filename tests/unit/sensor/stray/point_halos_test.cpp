// The halo of glare about points of light, near and far.

#include "sensor/stray/point_halos.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/units.h"
#include "tests/support/cameras.h"

namespace hilcam {
namespace {

constexpr double kGlare = 0.02, kRadius_px = 6;

double law(double distance_px) {
    return kGlare * kRadius_px /
           (2 * kPi * std::pow(kRadius_px * kRadius_px + distance_px * distance_px, 1.5));
}

CameraModel camera(int size_px, bool glare) {
    CameraModel c = camera_64();
    c.width_px = c.height_px = size_px;
    if (glare) c.stray_light.veiling_glare_fraction = kGlare, c.stray_light.glare_radius_px = kRadius_px;
    return c;
}

double per_irradiance(const CameraModel& c) {
    return static_cast<double>(electrons_per_s_per_irradiance(c, SpectralGrid({0.5, 0.6}))[0]);
}

PointSource point_of(const CameraModel& c, double x_px, double y_px, double electrons) {
    return point_at(x_px, y_px, electrons / per_irradiance(c));
}

// What glare has added to a picture without it, of which it leaves 1 - g: over the documented law, along a row, a column and a
// diagonal. The star lies in the picture or beside it.
void expect_the_law(int size_px, int guard_px, double x_px, double y_px) {
    constexpr double kElectrons = 1e8;
    Bench with(camera(size_px, true), {guard_px, 1, 1}), without(camera(size_px, false), {guard_px, 1, 1});
    const PointSource point = point_of(with.camera, x_px, y_px, kElectrons);
    const ElectronImage &seen = with.expose({.exposure_s = 1}, {{point}}),
                        &bare = without.expose({.exposure_s = 1}, {{point}});
    int places = 0;
    for (const auto& [dx, dy] : {std::array{1.0, 0.0}, {0.0, 1.0}, {-0.6, -0.8}, {0.7, -0.7}})
        for (const double r : {4.0,  6.0,  8.0,  12.0, 16.0, 20.0, 24.0, 28.0,  30.0,  32.0,  36.0, 40.0,
                               44.0, 48.0, 56.0, 62.0, 64.0, 66.0, 80.0, 100.0, 130.0, 160.0, 200.0}) {
            const int x = static_cast<int>(std::floor(x_px + r * dx)),
                      y = static_cast<int>(std::floor(y_px + r * dy));
            if (x < 0 || y < 0 || x >= size_px || y >= size_px) continue;
            const double added = at(seen, x, y) - (1 - kGlare) * at(bare, x, y);
            const double distance_px = std::hypot(x + 0.5 - x_px, y + 0.5 - y_px);
            EXPECT_NEAR(added / (kElectrons * law(distance_px)), 1, 0.06)
                << size_px << " px, " << distance_px;
            ++places;
        }
    EXPECT_GT(places, 8);
}

TEST(PointHalos, FollowTheLawFromTheCoreToTheFramesEdge) {
    expect_the_law(512, 256, 256.3, 255.8);
    expect_the_law(300, 16, 40.1, 240.5);
    expect_the_law(128, 32, 63.5, 63.5);
}

TEST(PointHalos, OfAStarInTheGuardBandLightTheFrame) { expect_the_law(256, 64, -30.2, 120.4); }

// The share of the law's own light that falls into the frame, and all that glare leaves.
TEST(PointHalos, KeepEveryElectron) {
    constexpr double kElectrons = 1e8;
    Bench bench(camera(512, true), {16, 1, 1});
    const PointSource point = point_of(bench.camera, 250.7, 260.2, kElectrons);
    const double all = sum(bench.expose({.exposure_s = 1}, {{point}}));
    double in_frame = 0;
    for (int y = 0; y < 512; ++y)
        for (int x = 0; x < 512; ++x) in_frame += law(std::hypot(x + 0.5 - 250.7, y + 0.5 - 260.2));
    EXPECT_NEAR(all / kElectrons, 1 - kGlare + in_frame, 3e-4);
    EXPECT_LT(all / kElectrons, 1 - 2e-4);
}

// Trails and close points are drawn together; far from them it makes no difference.
TEST(PointHalos, OfATrailAreThoseOfItsParts) {
    constexpr double kElectrons = 1e8;
    Bench bench(camera(256, true), {16, 1, 1}), without(camera(256, false), {16, 1, 1});
    PointSource trail = point_of(bench.camera, 128, 128, kElectrons);
    trail.drift_px_s = {60, 0};
    const ElectronImage &seen = bench.expose({.exposure_s = 1}, {{trail}}),
                        &bare = without.expose({.exposure_s = 1}, {{trail}});
    for (const int y : {128 + 12, 128 + 26, 128 + 50, 128 + 100})
        for (const int x : {128, 150, 200}) {
            double expected = 0;
            constexpr int kParts = 600;
            for (int i = 0; i < kParts; ++i)
                expected += kElectrons / kParts *
                            law(std::hypot(x + 0.5 - (98 + 60 * (i + 0.5) / kParts), y + 0.5 - 128));
            const double added = at(seen, x, y) - (1 - kGlare) * at(bare, x, y);
            EXPECT_NEAR(added / expected, 1, 0.06) << x << ' ' << y;
        }
}

TEST(PointHalos, OfFaintPointsAreInTheirTables) {
    const CameraModel c = camera(256, true);
    Bench bench(c, {16, 1, 1});
    const PointHalos halos(c.stray_light, geometry_of(c, 16));
    for (const double share : {0.99, 1.01}) {
        const PointSource point = point_of(c, 128.4, 128.4, share * halos.min_e());
        const ElectronImage& seen = bench.expose({.exposure_s = 1}, {{point}});
        // Seven tenths of a thousandth of an electron at 100 px: a faint point has nothing there.
        EXPECT_EQ(at(seen, 228, 128) > 0, share > 1);
        EXPECT_NEAR(sum(seen) / (share * halos.min_e()), 1, 0.002);
    }
    // A halo so wide that all of it is folded is drawn by itself sooner.
    StrayLightConfig wide = c.stray_light;
    wide.glare_radius_px = 1000;
    EXPECT_LT(PointHalos(wide, geometry_of(c, 16)).min_e(), halos.min_e());
}

TEST(PointHalos, EachColourHasItsOwn) {
    constexpr double kElectrons = 1e8;
    CameraModel c = camera(256, true);
    c.color_filter.pattern = "RG GB";
    c.color_filter.filters = {
        {"R", Curve::constant(0.3)}, {"G", Curve::constant(0.6)}, {"B", Curve::constant(0.9)}};
    Bench bench(c, {16, 1, 1});
    const PointSource point = point_of(c, 128.5, 128.5, kElectrons);
    const ElectronImage& seen = bench.expose({.exposure_s = 1}, {{point}});
    for (const auto& [x, y, filter] :
         {std::array{200.0, 128.0, 0.3}, {201.0, 128.0, 0.6}, {201.0, 129.0, 0.9}}) {
        const double expected = filter * kElectrons * law(std::hypot(x - 128, y - 128));
        EXPECT_NEAR(at(seen, static_cast<int>(x), static_cast<int>(y)) / expected, 1, 0.04) << filter;
    }
}

}  // namespace
}  // namespace hilcam
