#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "render/vocabulary/units.h"
#include "sensor/focal_plane.h"
#include "sensor/optics.h"
#include "tests/support/cameras.h"

namespace hilcam {
namespace {

TEST(StrayLight, EvenGlareTakesItsShareAndSpreadsIt) {
    CameraModel c = gaussian_camera(0.5);
    c.stray_light.veiling_glare_fraction = 0.1;
    Bench bench(c, {32, 1, 1});
    // Light in the left half of the padded picture.
    for (int y = 0; y < 128; ++y)
        for (std::size_t x = 0; x < 64; ++x) bench.radiance.row(y)[x] = 10;
    const ElectronImage& e = bench.expose({.exposure_s = 1});
    const double level = 10 * per_radiance(c, bench.grid);
    EXPECT_NEAR(at(e, 8, 32) / level, 0.9 + 0.1 * 0.5, 1e-4);
    EXPECT_NEAR(at(e, 56, 32) / level, 0.1 * 0.5, 1e-4);
}

TEST(StrayLight, APointsGlareIsItsShareOfThePicture) {
    CameraModel c = gaussian_camera(0.5);
    c.stray_light.veiling_glare_fraction = 0.2;
    Bench bench(c, {32, 1, 1});
    const PointSource p = point_at(32, 32, 1e-5);
    const ElectronImage& e = bench.expose({.exposure_s = 1}, {{p}});
    const double all = static_cast<double>(electrons_per_s_per_irradiance(c, bench.grid)[0]) * 1e-5;
    EXPECT_NEAR(at(e, 3, 60), 0.2 * all / (128 * 128), 1e-4 * all / (128 * 128));
    EXPECT_NEAR(sum(e) / all, 0.8 + 0.2 * 0.25, 1e-4);
}

// r / (2 pi (r^2 + x^2)^1.5) far from a small source.
TEST(StrayLight, AHaloFallsAsTheCubeOfTheDistance) {
    CameraModel c = gaussian_camera(0.5);
    c.width_px = c.height_px = 256;
    c.stray_light.veiling_glare_fraction = 0.1, c.stray_light.glare_radius_px = 4;
    c.full_well_e = 1e9;  // nothing is too bright for the FFT
    Bench bench(c, {64, 1, 2});
    for (int y = 382; y < 388; ++y)
        for (std::size_t x = 382; x < 388; ++x) bench.radiance.row(y)[x] = 1000;
    const ElectronImage& e = bench.expose({.exposure_s = 1});
    const double all = 9 * 1000 * per_radiance(c, bench.grid);
    for (const int x : {20, 40}) {
        const double expected = 0.1 * all * 4 / (2 * kPi * std::pow(16 + x * x, 1.5));
        // Copies of the periodic picture add to the halo: less than 4 % at 40 px.
        EXPECT_NEAR(at(e, 128 + x, 128) / expected, 1, 0.05) << x;
    }
}

// A lens whose ghost is mirrored about (128, 128) and half as far, and a light at (208, 80) [px]: a point or a square.
struct GhostScene {
    Bench bench;
    std::vector<PointSource> points;
    double all = 0;  // electrons that come in

    static CameraModel camera(double fraction) {
        CameraModel c = gaussian_camera(0.5);
        c.width_px = c.height_px = 256;
        c.stray_light.ghost_fraction = fraction, c.stray_light.ghost_scale = -0.5;
        c.stray_light.ghost_radius_px = 20;
        return c;
    }
    GhostScene(double fraction, bool as_point, double irradiance) : bench(camera(fraction)) {
        const CameraModel c = camera(fraction);
        if (as_point) {
            points.push_back(point_at(208, 80, irradiance));
            all = static_cast<double>(electrons_per_s_per_irradiance(c, bench.grid)[0]) * irradiance;
        } else {
            for (int y = 88 - 2; y < 88 + 2; ++y)
                for (std::size_t x = 216 - 2; x < 216 + 2; ++x) bench.radiance.row(y)[x] = 1000;
            all = 16 * 1000 * per_radiance(c, bench.grid);
        }
    }
    const ElectronImage& expose() { return bench.expose({.exposure_s = 1}, points); }
};

TEST(StrayLight, AGhostIsMirroredAndHasItsShare) {
    for (const bool as_point : {false, true}) {
        GhostScene scene(0.01, as_point, 1e-4);
        const ElectronImage& e = scene.expose();
        double ghost = 0, x_sum = 0, y_sum = 0;
        for (int y = 120; y < 184; ++y)
            for (int x = 56; x < 120; ++x)
                ghost += at(e, x, y), x_sum += at(e, x, y) * (x + 0.5), y_sum += at(e, x, y) * (y + 0.5);
        EXPECT_NEAR(ghost / scene.all, 0.01, 3e-4) << as_point;
        EXPECT_NEAR(x_sum / ghost, 88, 1) << as_point;
        EXPECT_NEAR(y_sum / ghost, 152, 1) << as_point;
        const double even = 0.01 * scene.all / (kPi * 20 * 20);
        EXPECT_NEAR(at(e, 88, 152), even, 0.1 * even) << as_point;
    }
}

// Two faces do not make light: what the ghost has, the image lacks, and a picture in which nothing leaves the field has
// the light that came in.
TEST(StrayLight, AGhostHasItsLightFromTheImage) {
    for (const bool as_point : {false, true}) {
        GhostScene scene(0.2, as_point, 1e-5);
        const ElectronImage& e = scene.expose();
        EXPECT_NEAR(sum(e) / scene.all, 1, 2e-3) << as_point;
        double image = 0;
        for (int y = 60; y < 100; ++y)
            for (int x = 188; x < 228; ++x) image += at(e, x, y);
        EXPECT_NEAR(image / scene.all, 0.8, 2e-3) << as_point;
    }
}

// The Sun near an edge: a disk of 8 px at 10^5 full wells. Its wings reach over the picture as lambda N /
// (pi^3 r^3), nothing rings along its rows, nothing comes back at the other edge.
TEST(StrayLight, TheSunsWingsReachOverThePicture) {
    CameraModel c = camera_64();
    c.width_px = c.height_px = 256;
    c.full_well_e = 1e4;
    Bench bench(c, {16, 1, 1});
    const float sun = static_cast<float>(1e9 / per_radiance(c, bench.grid));
    double pixels = 0;
    for (int y = 0; y < bench.radiance.height(); ++y)
        for (int x = 0; x < bench.radiance.width(); ++x)
            if (std::hypot(x + 0.5 - 144, y + 0.5 - 24) < 4) {
                bench.radiance.row(y)[static_cast<std::size_t>(x)] = sun;
                ++pixels;
            }
    const ElectronImage& e = bench.expose({.exposure_s = 1});
    const double wings = 0.55e-6 * 4 / 5.5e-6 / std::pow(kPi, 3) * pixels * 1e9;
    // Where table and wings meet, at 30 px along the axes and 42 across, there is no seam: rings of the image
    // that are averaged in the formula, and cells of 8 px, move it by a fifth at most.
    for (int r = 26; r < 48; ++r) {
        const double across = std::floor(r / std::sqrt(2.0));
        EXPECT_NEAR(at(e, 128 + r, 8) / (wings / std::pow(r + 0.5, 3)), 1, 0.2) << r;
        EXPECT_NEAR(at(e, 128 + static_cast<int>(across), 8 + static_cast<int>(across)) /
                        (wings / std::pow((across + 0.5) * std::sqrt(2.0), 3)),
                    1, 0.2)
            << r;
    }
    for (const int r : {60, 100, 200}) {
        // Below the Sun, and along its row: both as the formula says, whatever the pixel's parity.
        for (const int odd : {0, 1})
            EXPECT_NEAR(at(e, 128, 8 + r + odd) / (wings / std::pow(r + odd + 0.5, 3)), 1, 0.03) << r;
        if (r < 120) {
            EXPECT_NEAR(at(e, 128 + r, 8) / (wings / std::pow(r + 0.5, 3)), 1, 0.03) << r;
        }
    }
    // The FFT alone would bring a tenth of its light's level back here.
    EXPECT_LT(at(e, 128, 255), 1.1 * wings / std::pow(247, 3));
}

// Ten times too bright, or nearly: the picture goes on without a step.
TEST(StrayLight, BrightPixelsAreDrawnAsThePictureWouldDrawThem) {
    CameraModel c = gaussian_camera(0.6);
    const auto profile = [&](double full_well_e) {
        c.full_well_e = full_well_e;
        Bench bench(c, {16, 1000, 2});
        for (int y = 96; y < 100; ++y)
            for (std::size_t x = 96; x < 100; ++x)
                bench.radiance.row(y)[x] = static_cast<float>(1e6 / per_radiance(c, bench.grid));
        const ElectronImage& e = bench.expose({.exposure_s = 1});
        return std::vector<double>(e.row(33).begin(), e.row(33).end());
    };
    const std::vector<double> by_fft = profile(1e9), as_points = profile(1e3);
    // A radiance pixel's light from its middle instead of from all of it: half a pixel wide, 1 / 48 px^2
    // narrower.
    for (std::size_t x = 20; x < 44; ++x) EXPECT_NEAR(as_points[x], by_fft[x], 0.02 * 1e6) << x;
    EXPECT_NEAR(std::accumulate(as_points.begin(), as_points.end(), 0.0) /
                    std::accumulate(by_fft.begin(), by_fft.end(), 0.0),
                1, 0.01);
}

}  // namespace
}  // namespace hilcam
