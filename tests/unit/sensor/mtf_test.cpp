#include "sensor/mtf.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/units.h"
#include "sensor/optics.h"
#include "sensor/system_mtf.h"
#include "sensor/zernike.h"
#include "tests/support/cameras.h"

namespace hilcam {
namespace {

TEST(Mtf, DiffractionOfAClearPupilIsTheTextbookFormula) {
    for (const double s : {0.0, 0.2, 0.7, 1.0, 1.5, 1.9}) {
        // Goodman, Introduction to Fourier Optics, eq. 6-32: x = nu / cut-off.
        const double x = s / 2;
        EXPECT_NEAR(pupil_otf(s, 0, 0), 2 / kPi * (std::acos(x) - x * std::sqrt(1 - x * x)), 3e-4) << s;
    }
    EXPECT_EQ(pupil_otf(2.0, 0, 0), 0);
}

TEST(Mtf, ObscurationLowersMiddleFrequenciesAndLiftsHighOnes) {
    EXPECT_NEAR(pupil_otf(0, 0.5, 0), 1, 1e-3);
    EXPECT_LT(pupil_otf(0.6, 0.5, 0), pupil_otf(0.6, 0, 0));
    EXPECT_GT(pupil_otf(1.6, 0.5, 0), pupil_otf(1.6, 0, 0));
}

TEST(Mtf, StrongDefocusIsTheGeometricBlurDisk) {
    // Far out of focus the OTF is 2 J1(a)/a with a = 4 pi W s at low frequencies (Hopkins 1955); 20 waves,
    // small s.
    for (const double s : {0.005, 0.01, 0.015}) {
        const double a = 4 * kPi * 20 * s;
        EXPECT_NEAR(pupil_otf(s, 0, 20), 2 * std::cyl_bessel_j(1, a) / a, 0.01) << s;
    }
}

TEST(Mtf, RayGridOfOneIsNothingAndOfManyIsThePixel) {
    EXPECT_DOUBLE_EQ(ray_grid_mtf(0.4, 1), 1);
    EXPECT_NEAR(ray_grid_mtf(0.4, 1000), sinc(0.4), 1e-6);
    EXPECT_NEAR(ray_grid_mtf(0.5, 2), std::cos(kPi / 4), 1e-12);  // two rays at +-1/4 px
}

// Shannon's figure: at a tenth of a wave rms the contrast in the middle of the band falls by 31 %.
TEST(Mtf, AberrationsFollowShannon) {
    EXPECT_NEAR(aberration_mtf(1, 0.1), 1 - std::pow(0.1 / 0.18, 2), 1e-12);
    EXPECT_NEAR(aberration_mtf(0, 0.1), 1, 1e-12);
    EXPECT_NEAR(aberration_mtf(2, 0.1), 1, 1e-12);
    EXPECT_EQ(aberration_mtf(1, 0.5), 0);
}

TEST(Mtf, CrosstalkKeepsEvenLight) {
    EXPECT_DOUBLE_EQ(crosstalk_mtf(0, 0, 0.03), 1);
    EXPECT_NEAR(crosstalk_mtf(0.5, 0, 0.03), 1 - 4 * 0.03, 1e-12);
    EXPECT_NEAR(crosstalk_mtf(0.5, 0.5, 0.03), 1 - 8 * 0.03, 1e-12);
}

// Noll 1976, table I.
TEST(Zernike, TermsAreNolls) {
    const double x = 0.3, y = -0.4, r = 0.5, r2 = r * r;
    EXPECT_NEAR(zernike(1, x, y), 1, 1e-12);
    EXPECT_NEAR(zernike(2, x, y), 2 * x, 1e-12);
    EXPECT_NEAR(zernike(3, x, y), 2 * y, 1e-12);
    EXPECT_NEAR(zernike(4, x, y), std::sqrt(3.0) * (2 * r2 - 1), 1e-12);
    EXPECT_NEAR(zernike(5, x, y), std::sqrt(6.0) * 2 * x * y, 1e-12);
    EXPECT_NEAR(zernike(6, x, y), std::sqrt(6.0) * (x * x - y * y), 1e-12);
    EXPECT_NEAR(zernike(7, x, y), std::sqrt(8.0) * (3 * r2 - 2) * y, 1e-12);
    EXPECT_NEAR(zernike(8, x, y), std::sqrt(8.0) * (3 * r2 - 2) * x, 1e-12);
    EXPECT_NEAR(zernike(11, x, y), std::sqrt(5.0) * (6 * r2 * r2 - 6 * r2 + 1), 1e-12);
}

// A wavefront of defocus alone, by the FFT of the pupil and by the closed form across the shift. W20 is the
// wavefront at the edge; Z4 has 2 sqrt 3 of its coefficient from middle to edge.
TEST(Zernike, DefocusIsThatOfTheClosedForm) {
    for (const double obscuration : {0.0, 0.4}) {
        const double w20 = 0.4;
        const std::vector<double> z4 = {w20 / (2 * std::sqrt(3.0))};
        const PupilTransfer by_zernike(obscuration, 0, z4), by_w20(obscuration, w20, {});
        for (const double s : {0.1, 0.5, 1.0, 1.6}) {
            const double expected = pupil_otf(s, obscuration, w20);
            EXPECT_NEAR(by_w20.at(s, 0).real(), expected, 2e-3) << s;
            EXPECT_NEAR(by_zernike.at(0, s).real(), expected, 2e-3) << s;
            EXPECT_NEAR(by_w20.at(s, 0).imag(), 0, 1e-4) << s;
        }
    }
}

// Coma sends the light to one side, of a point and of a small bright square alike: points all over it, and
// the radiance image through the FFT.
TEST(Zernike, ComaMovesPointsAndPictureAlike) {
    CameraModel c = camera_64();
    c.zernike_m = {0, 0, 0, 0, 60e-9};  // Noll 8: along x
    c.f_number = 8;
    Bench bench(c, {8, 1000, 2});
    const auto centroid = [](const ElectronImage& e) {
        double sum = 0, x_sum = 0, y_sum = 0;
        for (int y = 22; y < 42; ++y)
            for (int x = 22; x < 42; ++x) {
                const double v = static_cast<double>(e.row(y)[static_cast<std::size_t>(x)]);
                sum += v, x_sum += v * (x + 0.5 - 32), y_sum += v * (y + 0.5 - 32);
            }
        return Vec2d{x_sum / sum, y_sum / sum};
    };
    std::vector<PointSource> points;
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i) {
            PointSource p;  // radiance pixels 62 to 66 of the frame
            p.position_px = {62.25f + 0.5f * static_cast<float>(i), 62.25f + 0.5f * static_cast<float>(j)};
            p.irradiance_w_m2_um[0] = 1e-6f;
            points.push_back(p);
        }
    const Vec2d of_points = centroid(bench.expose({.exposure_s = 1}, points));
    EXPECT_GT(std::abs(of_points.x), 0.05);
    EXPECT_NEAR(of_points.y, 0, 2e-3);
    for (int y = 78; y < 82; ++y)
        for (std::size_t x = 78; x < 82; ++x) bench.radiance.row(y)[x] = 100;
    const Vec2d of_square = centroid(bench.expose({.exposure_s = 1}));
    EXPECT_NEAR(of_square.x, of_points.x, 2e-3);
    EXPECT_NEAR(of_square.y, 0, 2e-3);
}

TEST(SystemMtf, IsTheProductOfItsParts) {
    CameraModel c = camera_64();
    c.measured_mtf.mtf = {{0, 50, 200}, {1, 0.6, 0}};
    c.fill_factor = 0.64;
    c.diffusion_m = 1.1e-6;
    c.crosstalk_fraction = 0.01;
    c.jitter.rms_rad = {0, 2e-5};
    c.stray_light.veiling_glare_fraction = 0.02;
    const SensorChain chain(c, SpectralGrid({0.5, 0.6}), {8, 1, 1});
    // 0.5 cycles/px are 90.9 cycles/mm; jitter about y of 2e-5 rad is 0.1818 px along x.
    const double lens = 0.6 + (90.909 - 50) / 150 * -0.6;
    const double expected =
        lens * sinc(0.5 * 0.8) * std::exp(-2 * std::pow(kPi * 0.5 * 0.2, 2)) * 0.96 * 0.98;
    EXPECT_NEAR(chain.mtf(0, 0.5), expected, 2e-3);
    EXPECT_NEAR(chain.mtf(0.5, 0), expected * std::exp(-2 * std::pow(kPi * 0.5 * 0.18182, 2)), 2e-3);
    EXPECT_NEAR(chain.mtf(0, 0), 1, 1e-9);
}

TEST(SystemMtf, CrosstalkCountsUnderAMosaicToo) {
    CameraModel c = camera_64();
    c.crosstalk_fraction = 0.02;
    const SpectralGrid grid({0.5, 0.6});
    const double plain = SensorChain(c, grid, {8, 1, 1}).mtf(0.3, 0.2);
    c.color_filter = {"G", {{"G", Curve::constant(0.5)}}};
    EXPECT_NEAR(SensorChain(c, grid, {8, 1, 1}).mtf(0.3, 0.2), plain, 1e-9);
}

TEST(SystemMtf, ALineCameraBlursAlongItsTrack) {
    CameraModel c = camera_64();
    const SpectralGrid grid({0.5, 0.6});
    const double still = SensorChain(c, grid, {8, 1, 1}).mtf(0, 0.5);
    c.shutter.kind = ShutterKind::kLineScan;
    c.shutter.tdi_stages = 32, c.shutter.tdi_phases = 4, c.shutter.tdi_mismatch_fraction = 0.02;
    const SensorChain chain(c, grid, {8, 1, 1});
    EXPECT_NEAR(chain.mtf(0, 0.5) / still, sinc(0.5 / 4) * sinc(0.5 * 32 * 0.02), 1e-6);
    EXPECT_NEAR(chain.mtf(0.5, 0) / still, 1, 1e-6);
}

// Between two zones the image is a blend: in the middle of the field sharp, in the corner blurred.
TEST(FieldZones, BlurGrowsTowardsTheCornerAndKeepsTheLight) {
    CameraModel c = camera_64();
    c.width_px = c.height_px = 128;
    c.field_zones = {{0, 0, 0}, {1, 60e-6, 0}};
    Bench bench(c, {16, 1, 1});
    const auto peak_share = [&](float x, float y) {
        PointSource p;
        p.position_px = {x, y};
        p.irradiance_w_m2_um[0] = 1e-6f;
        const ElectronImage& e = bench.expose({.exposure_s = 1}, {{p}});
        double most = 0, sum = 0;
        for (const float v : e.all())
            most = std::max(most, static_cast<double>(v)), sum += static_cast<double>(v);
        return std::pair(most / sum, sum);
    };
    const auto [sharp, all] = peak_share(64.5f, 64.5f);
    const auto [half, all_half] = peak_share(64.5f + 22.0f, 64.5f + 22.0f);
    const auto [blurred, all_corner] = peak_share(64.5f + 30.0f, 64.5f + 30.0f);
    EXPECT_GT(sharp, 1.4 * blurred);
    EXPECT_GT(half, blurred);
    EXPECT_NEAR(all_half / all, 1, 1e-4);
    bench.fill(10);
    const ElectronImage& even = bench.expose({.exposure_s = 1});
    // Where the blur changes an even field is uneven by half the blur's variance times the blend's second
    // derivative: 1.5 px^2 and 6 / 90^2 px^-2.
    EXPECT_NEAR(static_cast<double>(even.row(64)[64]) / static_cast<double>(even.row(74)[64]), 1, 1.2e-3);
}

}  // namespace
}  // namespace hilcam
