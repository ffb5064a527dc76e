// Photon book-keeping: what arrives at the aperture and what the pixels have of it, in closed forms.

#include "sensor/focal_plane.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "render/stars.h"
#include "render/units.h"
#include "sensor/optics.h"
#include "tests/support/cameras.h"
#include "tests/support/statistics.h"

namespace hilcam {
namespace {

// Electrons per second and unit of radiance, on the axis.
double per_radiance(const CameraModel& c, const SpectralGrid& grid) {
    return static_cast<double>(electrons_per_s_per_radiance(c, grid)[0]);
}

double at(const ElectronImage& image, int x, int y) {
    return static_cast<double>(image.row(y)[static_cast<std::size_t>(x)]);
}
double sum(const ElectronImage& image) {
    double total = 0;
    for (const float v : image.all()) total += static_cast<double>(v);
    return total;
}

PointSource point_at(double x, double y, double irradiance) {
    PointSource p;
    p.position_px = {static_cast<float>(x), static_cast<float>(y)};
    p.irradiance_w_m2_um[0] = static_cast<float>(irradiance);
    return p;
}

// L A Omega T QE t dlambda lambda / (h c), one narrow bin.
TEST(FocalPlane, UniformFieldGivesTheClosedFormElectrons) {
    CameraModel c = camera_64();
    const SpectralGrid grid({0.549, 0.551});
    SensorChain chain(c, grid, {8, 1, 1});
    RadianceImage radiance(80, 80, 1);
    for (float& v : radiance.all()) v = 100;
    ElectronImage mean(64, 64);
    chain.expose(radiance, {}, {.exposure_s = 1e-3}, mean);
    const double d = 0.05 / 4, area = kPi / 4 * d * d, omega = std::pow(5.5e-6 / 0.05, 2);
    const double expected =
        100 * area * omega * 0.9 * 0.5 * 1e-3 * 0.002 * 0.55e-6 / (6.62607015e-34 * 299792458.0);
    EXPECT_NEAR(at(mean, 32, 32) / expected, 1, 1e-5);
}

TEST(FocalPlane, ATNumberIsTheTransmission) {
    CameraModel c = camera_64();
    c.has_t_number = true, c.t_number = 5;
    CameraModel same = camera_64();
    same.transmission = Curve::constant(16.0 / 25.0);
    EXPECT_NEAR(per_radiance(c, SpectralGrid({0.5, 0.6})) / per_radiance(same, SpectralGrid({0.5, 0.6})), 1,
                1e-6);
}

// At every size of the radiance grid, the whole picture's light is what went in.
TEST(FocalPlane, OversamplingChangesNoElectron) {
    for (const int m : {1, 2, 3, 4}) {
        Bench bench(gaussian_camera(0.5), {8, 1, m});
        bench.fill(10);
        const double expected = 10 * per_radiance(bench.camera, bench.grid);
        EXPECT_NEAR(at(bench.expose({.exposure_s = 1}), 32, 32) / expected, 1, 1e-5) << m;
    }
}

// An upright edge of which radiance pixels know their exact share: across it all electrons are there, the
// profile is the integral of a Gaussian over the pixel within what the radiance image's own sampling folds
// back, which falls with the square of the oversampling.
TEST(FocalPlane, AnEdgeIsItsClosedFormWhereverItFallsInAPixel) {
    constexpr double kSigma_px = 0.5;
    for (const int m : {1, 2, 4})
        for (const double edge_px : {32.0, 32.3, 32.77}) {
            // The picture is periodic: its other edge lies in the guard band. Averages over radiance pixels
            // are what infinitely many rays give.
            Bench bench(gaussian_camera(kSigma_px), {16, 1000, m});
            for (int y = 0; y < bench.radiance.height(); ++y)
                for (int x = 0; x < bench.radiance.width(); ++x) {
                    const double left = (x + 0.0) / m - 16;
                    bench.radiance.row(y)[static_cast<std::size_t>(x)] =
                        static_cast<float>(2 + 8 * std::clamp((left + 1.0 / m - edge_px) * m, 0.0, 1.0));
                }
            const ElectronImage& e = bench.expose({.exposure_s = 1});
            const double one = per_radiance(bench.camera, bench.grid);
            // Integral of the normal distribution's integral: G(t) = t Phi(t) + phi(t).
            const auto integral = [&](double x) {
                const double t = x / kSigma_px;
                return kSigma_px * (t * normal_cdf(t) + std::exp(-t * t / 2) / std::sqrt(2 * kPi));
            };
            double worst = 0, total = 0, expected_total = 0;
            for (int x = 20; x < 44; ++x) {
                const double share = integral(x + 1 - edge_px) - integral(x - edge_px);
                worst = std::max(worst, std::abs(at(e, x, 32) / one - (2 + 8 * share)));
                total += at(e, x, 32) / one, expected_total += 2 + 8 * share;
            }
            EXPECT_NEAR(total / expected_total, 1, m == 1 ? 5e-5 : 1e-5) << m << ' ' << edge_px;
            EXPECT_LT(worst / 8, 0.08 / (m * m)) << m << ' ' << edge_px;
        }
}

// A point on a detector with gaps: each pixel has the integral of the Gaussian over its light-sensitive
// square.
TEST(FocalPlane, APointIsItsClosedFormWhereverItFallsInAPixel) {
    constexpr double kSigma_px = 0.6;
    for (const double fill : {1.0, 0.49}) {
        CameraModel c = gaussian_camera(kSigma_px);
        c.fill_factor = fill;
        Bench bench(c);
        const double half = 0.5 * std::sqrt(fill);
        const double all = static_cast<double>(electrons_per_s_per_irradiance(c, bench.grid)[0]) * 1e-6;
        for (const double dx : {0.0, 0.13, 0.5, 0.77, 0.999})
            for (const double dy : {0.25, 0.6}) {
                const PointSource p = point_at(32 + dx, 30 + dy, 1e-6);
                const ElectronImage& e = bench.expose({.exposure_s = 1}, {{p}});
                const auto share = [&](int pixel, float center) {
                    const double from = pixel + 0.5 - half - static_cast<double>(center);
                    return normal_cdf((from + 2 * half) / kSigma_px) - normal_cdf(from / kSigma_px);
                };
                double total = 0;
                for (int y = 0; y < 64; ++y)
                    for (int x = 0; x < 64; ++x) {
                        const double expected = share(x, p.position_px.x) * share(y, p.position_px.y);
                        EXPECT_NEAR(at(e, x, y) / all, expected, 1e-5)
                            << dx << ' ' << dy << ' ' << x << ' ' << y;
                        total += expected;
                    }
                EXPECT_NEAR(sum(e) / all, total, 1e-5) << dx << ' ' << dy;
            }
    }
}

// The diffraction pattern's far rings are folded in: no electron is lost.
TEST(FocalPlane, AStarsElectronsAreAllThereWhereverItFalls) {
    CameraModel c;
    c.width_px = c.height_px = 128;
    c.pitch_m = 5e-6, c.focal_length_m = 0.08, c.f_number = 4;
    c.transmission = Curve::constant(0.9), c.quantum_efficiency = Curve::constant(0.5);
    const SpectralGrid grid({0.545, 0.555});
    // V = 2 through an aperture of 20 mm, 90 % of glass and 50 % of quanta, 100 ms, in a bin of 10 nm at 0.55
    // um: 3.63e-8 W m^-2 um^-1 10^(-0.4 2) 0.01 um, photons of 3.6117e-19 J. The star is white enough that
    // its mean over the bin is that of the middle within 1e-3.
    const double watts_m2 = 3.63e-8 * std::pow(10.0, -0.8) * 0.01;
    const double photon_j = 6.62607015e-34 * 299792458.0 / 0.55e-6;
    const double expected = watts_m2 * kPi * 0.01 * 0.01 * 0.9 * 0.5 * 0.1 / photon_j;
    SensorChain chain(c, grid, {8, 1, 1});
    const RadianceImage dark(144, 144, 1);
    ElectronImage electrons(128, 128);
    double first = 0;
    for (const float dx : {0.0f, 0.3f, 0.62f, 0.9f}) {
        PointSource star;
        star.position_px = {64 + dx, 63.8f - 0.5f * dx};
        star.irradiance_w_m2_um = star_irradiance_w_m2_um(2, 0, grid);
        chain.expose(dark, {{star}}, {.exposure_s = 0.1}, electrons);
        EXPECT_NEAR(sum(electrons) / expected, 1, 1e-3);
        if (first == 0) first = sum(electrons);
        EXPECT_NEAR(sum(electrons) / first, 1, 1e-5) << dx;
    }
}

TEST(FocalPlane, FalloffIsCosineToTheFourthAndVignettingComesOnTop) {
    CameraModel c = camera_64();
    c.focal_length_m = 0.0005;  // 64 px are 39 degrees off the axis in the corner
    c.vignetting = {{0, 0.5, 1}, {1, 1, 0.6}};
    const RelativeIllumination lens(c, geometry_of(c, 0));
    const double tangent = 31.5 * std::sqrt(2.0) * 5.5e-6 / 0.0005;
    const double cosine4 = std::pow(1 / (1 + tangent * tangent), 2);
    EXPECT_NEAR(lens.at(63.5, 63.5), cosine4 * (1 - 0.4 * (31.5 / 32 - 0.5) / 0.5), 1e-9);
    EXPECT_NEAR(lens.at(32, 48), std::pow(1 + std::pow(16 * 5.5e-6 / 0.0005, 2), -2), 1e-9);
}

TEST(FocalPlane, AllLinesOfALineCameraLieOnTheAxis) {
    CameraModel c = camera_64();
    c.focal_length_m = 0.0005, c.shutter.kind = ShutterKind::kLineScan;
    const RelativeIllumination lens(c, geometry_of(c, 0));
    EXPECT_EQ(lens.at(10.5, 0.5), lens.at(10.5, 32));
    EXPECT_EQ(lens.of_point(10.5, 0.5), lens.of_point(10.5, 60));
    EXPECT_NEAR(lens.field_fraction(64, 0), 1, 1e-12);
}

// A field of points, one in the middle of every pixel's solid angle, and a uniform field of the same
// radiance.
TEST(FocalPlane, PointsAndUniformFieldAgreeThroughAnyLens) {
    for (const bool fisheye : {false, true}) {
        CameraModel c = camera_64();
        c.focal_length_m = 0.0003;
        if (fisheye)
            c.projection = Projection::kFisheye;
        else
            c.distortion = {-0.05, 0.01};
        const ImageGeometry g = geometry_of(c, 0);
        const RelativeIllumination lens(c, g);
        for (const Vec2d p : {Vec2d{32.5, 32.5}, Vec2d{10.5, 20.5}, Vec2d{60.5, 58.5}}) {
            // Solid angle of the pixel from its four corners (two flat triangles; Van Oosterom & Strackee
            // 1983).
            const auto corner = [&](double x, double y) {
                return normalized(g.direction_camera(p.x + x, p.y + y));
            };
            const auto triangle = [](Vec3d a, Vec3d b, Vec3d d) {
                return 2 * std::atan2(std::abs(dot(a, cross(b, d))), 1 + dot(a, b) + dot(b, d) + dot(d, a));
            };
            const double omega = triangle(corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5)) +
                                 triangle(corner(-0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5));
            const double omega_axis = std::pow(c.pitch_m / c.focal_length_m, 2);
            EXPECT_NEAR(lens.of_point(p.x, p.y) * omega / omega_axis / lens.at(p.x, p.y), 1, 1e-3)
                << fisheye << ' ' << p.x;
        }
    }
}

TEST(FocalPlane, LightFromOneEdgeDoesNotComeBackAtTheOther) {
    Bench bench(camera_64(), {16, 1, 1});
    for (int y = 0; y < 96; ++y) bench.radiance.row(y)[16] = 1e6f;  // the frame's first column
    const ElectronImage& e = bench.expose({.exposure_s = 1e-3});
    EXPECT_LT(at(e, 63, 32), 1e-3 * at(e, 0, 32));
}

// 64 + 2 x 5 is 2 x 37: the FFT works on 80 x 80, and nothing of a frame is left beside the picture in the
// next one.
TEST(FocalPlane, TheBorderOfTheFftStaysDark) {
    for (const bool zones : {false, true}) {
        CameraModel c = gaussian_camera(0.5);
        if (zones) c.field_zones = {{0, 0, 0}, {1, 0, 0}};
        Bench bench(c, {5, 1, 1});
        bench.fill(10);
        const ElectronImage& e = bench.expose({.exposure_s = 1});
        const std::vector<float> first(e.all().begin(), e.all().end());
        for (int i = 0; i < 3; ++i) bench.expose({.exposure_s = 1});
        EXPECT_TRUE(std::equal(first.begin(), first.end(), bench.electrons.all().begin())) << zones;
        EXPECT_NEAR(at(bench.electrons, 32, 32) / (10 * per_radiance(c, bench.grid)), 1, 1e-4);
    }
}

TEST(FocalPlane, AnEmptyPictureCostsNothingAndIsTheSame) {
    Bench marked(camera_64()), plain(camera_64());
    for (int y = 0; y < 80; y += RadianceImage::kBlock_px)
        for (int x = 0; x < 80; x += RadianceImage::kBlock_px) marked.radiance.mark_dark(x, y, true);
    const PointSource star = point_at(20.2, 40.4, 1e-7);
    const ElectronImage& a = marked.expose({.exposure_s = 0.1}, {{star}});
    const ElectronImage& b = plain.expose({.exposure_s = 0.1}, {{star}});
    EXPECT_TRUE(std::equal(a.all().begin(), a.all().end(), b.all().begin()));
}

// --- stray light
// ---------------------------------------------------------------------------------------------------

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

TEST(StrayLight, AGhostIsMirroredAndHasItsShare) {
    CameraModel c = gaussian_camera(0.5);
    c.width_px = c.height_px = 256;
    c.stray_light.ghost_fraction = 0.01, c.stray_light.ghost_scale = -0.5;
    c.stray_light.ghost_radius_px = 20;
    for (const bool as_point : {false, true}) {
        Bench bench(c);
        std::vector<PointSource> points;
        double all = 0;
        if (as_point) {
            points.push_back(point_at(208, 80, 1e-4));
            all = static_cast<double>(electrons_per_s_per_irradiance(c, bench.grid)[0]) * 1e-4;
        } else {
            for (int y = 88 - 2; y < 88 + 2; ++y)
                for (std::size_t x = 216 - 2; x < 216 + 2; ++x) bench.radiance.row(y)[x] = 1000;
            all = 16 * 1000 * per_radiance(c, bench.grid);
        }
        const ElectronImage& e = bench.expose({.exposure_s = 1}, points);
        // Mirrored about (128, 128) and half as far: (88, 152).
        double ghost = 0, x_sum = 0, y_sum = 0;
        for (int y = 120; y < 184; ++y)
            for (int x = 56; x < 120; ++x)
                ghost += at(e, x, y), x_sum += at(e, x, y) * (x + 0.5), y_sum += at(e, x, y) * (y + 0.5);
        EXPECT_NEAR(ghost / all, 0.01, 3e-4) << as_point;
        EXPECT_NEAR(x_sum / ghost, 88, 1) << as_point;
        EXPECT_NEAR(y_sum / ghost, 152, 1) << as_point;
        EXPECT_NEAR(at(e, 88, 152), 0.01 * all / (kPi * 20 * 20), 0.1 * 0.01 * all / (kPi * 20 * 20))
            << as_point;
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

// --- motion
// --------------------------------------------------------------------------------------------------------

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

// --- colours
// -------------------------------------------------------------------------------------------------------

TEST(ColorFilters, EveryPixelHasItsOwnFiltersElectrons) {
    CameraModel c = gaussian_camera(0.4);
    c.color_filter = {
        "RG GB", {{"R", Curve::constant(0.8)}, {"G", Curve::constant(0.5)}, {"B", Curve::constant(0.2)}}};
    c.window_px = {1, 0, 32, 32};
    Bench bench(c);
    bench.fill(10);
    const ElectronImage& e = bench.expose({.exposure_s = 1});
    CameraModel open = c;
    open.color_filter = {};
    const double all = 10 * per_radiance(open, bench.grid);
    // The window begins one column to the right: GR BG.
    EXPECT_NEAR(at(e, 10, 10) / all, 0.5, 1e-4);
    EXPECT_NEAR(at(e, 11, 10) / all, 0.8, 1e-4);
    EXPECT_NEAR(at(e, 10, 11) / all, 0.2, 1e-4);
    EXPECT_NEAR(at(e, 11, 11) / all, 0.5, 1e-4);
}

TEST(ColorFilters, CrosstalkMixesNeighbouringColours) {
    CameraModel c = gaussian_camera(0.4);
    c.color_filter = {
        "RG GB", {{"R", Curve::constant(0.8)}, {"G", Curve::constant(0.5)}, {"B", Curve::constant(0.2)}}};
    c.crosstalk_fraction = 0.02;
    Bench bench(c);
    bench.fill(10);
    const ElectronImage& e = bench.expose({.exposure_s = 1});
    CameraModel open = c;
    open.color_filter = {};
    const double all = 10 * per_radiance(open, bench.grid);
    EXPECT_NEAR(at(e, 10, 10) / all, 0.92 * 0.8 + 0.08 * 0.5, 1e-4);
    EXPECT_NEAR(at(e, 11, 10) / all, 0.92 * 0.5 + 0.04 * 0.8 + 0.04 * 0.2, 1e-4);
}

}  // namespace
}  // namespace hilcam
