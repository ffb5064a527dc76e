#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/units.h"
#include "sensor/focal_plane.h"
#include "tests/support/cameras.h"
#include "tests/support/statistics.h"

namespace hilcam {
namespace {

// A pixel-wide line that moves by 6 px: an even bar of the same light.
TEST(Motion, SmearSpreadsALineEvenly) {
    Bench bench(gaussian_camera(0.5), {16, 1000, 2});
    for (int y = 0; y < bench.radiance.height(); ++y)
        for (int x = 2 * 48; x < 2 * 48 + 2; ++x) bench.radiance.row(y)[static_cast<std::size_t>(x)] = 100;
    const ElectronImage& e = bench.expose({.exposure_s = 0.5, .image_rate_px_s = {12, 0}});
    const double line = 100 * 0.5 * per_radiance(bench.camera, bench.grid);
    double total = 0;
    for (int x = 0; x < 64; ++x) total += at(e, x, 32);
    EXPECT_NEAR(total / line, 1, 1e-4);
    for (const int x : {31, 32, 33}) EXPECT_NEAR(at(e, x, 32) / line, 1.0 / 6, 1e-3) << x;
    EXPECT_NEAR(at(e, 38, 32) / line, 0, 1e-3);
}

// A star in a camera that turns about y by half a degree a second: f omega t along the row, and none is lost.
TEST(Motion, AStarLeavesATrail) {
    CameraModel c = gaussian_camera(0.4);
    Bench bench(c);
    const double rate = 8.0 / (c.focal_length_m / c.pitch_m) / 0.1;
    const PointSource p = point_at(32.5, 20.5, 1e-6);
    const ElectronImage& e = bench.expose({.exposure_s = 0.1, .camera_rate_rad_s = {0, rate, 0}}, {{p}});
    const double all = static_cast<double>(electrons_per_s_per_irradiance(c, bench.grid)[0]) * 1e-6 * 0.1;
    EXPECT_NEAR(sum(e) / all, 1, 1e-5);
    double row = 0;
    for (int y = 17; y < 24; ++y) row += at(e, 32, y);
    EXPECT_NEAR(row / all, 1.0 / 8, 2e-3);
    double x_sum = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) x_sum += at(e, x, y) * (x + 0.5);
    EXPECT_NEAR(x_sum / sum(e), 32.5, 1e-3);
}

// A density of 100 arcsec^2/Hz from 50 to 150 Hz is 10^4 arcsec^2; an exposure of a second blurs all of it:
// 100 arcsec are 4.4 px. A star and a small square have that variance.
TEST(Motion, JitterOfADensityBlursPointsAndPicture) {
    CameraModel c = gaussian_camera(0.5);
    c.jitter.psd_arcsec2_hz = {{50, 150}, {100, 100}};
    const double sigma_px = std::sqrt(jitter_blur_rad2(c.jitter, 1.0)) * c.focal_length_m / c.pitch_m;
    EXPECT_NEAR(sigma_px, 100 * kArcsecond_rad * 0.05 / 5.5e-6, 0.01);
    Bench bench(c, {32, 1, 1});
    const auto variance = [](const ElectronImage& e) {
        double sum_all = 0, squares = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x)
                sum_all += at(e, x, y), squares += at(e, x, y) * (x + 0.5 - 32) * (x + 0.5 - 32);
        return squares / sum_all;
    };
    const PointSource p = point_at(32, 32, 1e-6);
    // Detector and pixel add theirs; what lies beyond three standard deviations is cut off (2.7 %).
    const double expected = sigma_px * sigma_px + 0.25 + 1.0 / 12;
    EXPECT_NEAR(variance(bench.expose({.exposure_s = 1}, {{p}})) / expected, 1, 0.03);
    for (int y = 63; y < 65; ++y)
        for (std::size_t x = 63; x < 65; ++x) bench.radiance.row(y)[x] = 100;
    EXPECT_NEAR(variance(bench.expose({.exposure_s = 1})) / (expected + 0.25), 1, 0.01);
}

}  // namespace
}  // namespace hilcam
