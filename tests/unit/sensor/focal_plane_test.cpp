// Photon book-keeping: what arrives at the aperture and what the pixels have of it, in closed forms.

#include "sensor/focal_plane.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/units.h"
#include "sensor/optics.h"
#include "tests/support/cameras.h"
#include "tests/support/statistics.h"

namespace hilcam {
namespace {

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

// The same edge by four samples across a pixel, without and with which half of it they are in.
TEST(FocalPlane, AnEdgeIsItsClosedFormByHalvesOfPixels) {
    constexpr double kSigma_px = 0.5;
    const auto worst_error = [](double edge_px, bool moments) {
        Bench bench(gaussian_camera(kSigma_px), {16, moments ? halved(4) : RayGrid{4}, 1});
        bench.radiance.keep_moments({electrons_per_s_per_radiance(bench.camera, bench.grid)});
        SubpixelLight& light = *bench.radiance.moments();
        light.set_used(moments);
        const double one = per_radiance(bench.camera, bench.grid);
        for (int y = 0; y < bench.radiance.height(); ++y)
            for (int x = 0; x < bench.radiance.width(); ++x) {
                std::array<double, 2> half{};  // mean of 2 + 8 in each
                for (int i = 0; i < 4; ++i)
                    half[static_cast<std::size_t>(i / 2)] += x - 16 + (i + 0.5) / 4 > edge_px ? 5 : 1;
                bench.radiance.row(y)[static_cast<std::size_t>(x)] =
                    static_cast<float>((half[0] + half[1]) / 2);
                light.row(y, 0, 0)[static_cast<std::size_t>(x)] =
                    static_cast<float>(one * (half[1] - half[0]) / 2);
                light.mark_unknown(x, y, false);
                light.kinds(y)[static_cast<std::size_t>(x)] = SubpixelKind::kObject;
            }
        const ElectronImage& e = bench.expose({.exposure_s = 1});
        const auto integral = [&](double x) {
            const double t = x / kSigma_px;
            return kSigma_px * (t * normal_cdf(t) + std::exp(-t * t / 2) / std::sqrt(2 * kPi));
        };
        double worst = 0, total = 0, expected_total = 0;
        for (int x = 20; x < 44; ++x) {
            const double expected = 2 + 8 * (integral(x + 1 - edge_px) - integral(x - edge_px));
            worst = std::max(worst, std::abs(at(e, x, 32) / one - expected));
            total += at(e, x, 32) / one, expected_total += expected;
        }
        EXPECT_NEAR(total / expected_total, 1, 1e-4) << edge_px;
        return worst / 8;
    };
    double without = 0, with = 0;
    for (const double edge_px : {32.0, 32.25, 32.5, 32.75}) {
        without = std::max(without, worst_error(edge_px, false));
        with = std::max(with, worst_error(edge_px, true));
    }
    EXPECT_GT(without, 0.04);
    EXPECT_LT(with, 0.015);
}

// Light in a pixel's lower right quarter is seen a quarter of a pixel further down and to the right, and none is
// lost; so is light that is far too bright, which becomes a point.
TEST(FocalPlane, LightInAQuarterOfAPixelIsSeenThere) {
    for (const float electrons : {1e5f, 1e8f})
        for (const Vec2d smear_px : {Vec2d{0, 0}, Vec2d{0.8, -0.4}}) {
            Bench bench(gaussian_camera(0.7), {16, halved(4), 1});
            bench.radiance.keep_moments({electrons_per_s_per_radiance(bench.camera, bench.grid)});
            SubpixelLight& light = *bench.radiance.moments();
            light.set_used(true);
            // Next to a block's corner: its image lies in four of them.
            const int x = 31 + 32, y = 32;
            const auto one = static_cast<float>(per_radiance(bench.camera, bench.grid));
            constexpr double kAbout_e = 1e4;  // nowhere does the lens' ringing go below zero
            bench.fill(static_cast<float>(kAbout_e) / one);
            ElectronImage about(64, 64);
            bench.chain.expose(bench.radiance, {}, {.exposure_s = 1}, about);
            bench.radiance.row(y)[x] += electrons / one;
            for (int d = 0; d < SubpixelLight::kDifferences; ++d) light.row(y, d, 0)[x] = electrons;
            light.mark_unknown(x, y, false);
            light.kinds(y)[static_cast<std::size_t>(x)] = SubpixelKind::kObject;
            const ElectronImage& e = bench.expose({.exposure_s = 1, .image_rate_px_s = smear_px});
            Vec2d middle_px{};
            double sum_e = 0;
            for (int j = 0; j < 64; ++j)
                for (int i = 0; i < 64; ++i) {
                    const double more_e = at(e, i, j) - at(about, i, j);
                    middle_px.x += more_e * (i + 0.5), middle_px.y += more_e * (j + 0.5);
                    sum_e += more_e;
                }
            EXPECT_NEAR(middle_px.x / sum_e, x - 16 + 0.75, 0.01) << electrons << ' ' << smear_px.x;
            EXPECT_NEAR(middle_px.y / sum_e, y - 16 + 0.75, 0.01) << electrons << ' ' << smear_px.x;
            EXPECT_NEAR(sum_e / static_cast<double>(electrons), 1, 0.002) << electrons << ' ' << smear_px.x;
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
    // um: 3.63e-8 W m^-2 um^-1 10^(-0.4 2) 0.01 um, photons of 3.6117e-19 J.
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
        star.irradiance_w_m2_um[0] = static_cast<float>(3.63e-8 * std::pow(10.0, -0.8));
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

// A frame whose rays were placed in another way than usual is convolved for that way: as by a chain made for
// it, by kernel and by FFT.
TEST(FocalPlane, AFramesRayGridMayBeAnother) {
    for (const bool by_kernel : {true, false}) {
        CameraModel c = by_kernel ? gaussian_camera(0.7) : camera_64();
        for (const RayGrid rays : {kScatteredRays, 1, 4}) {
            Bench usual(c, {8, 2, 1, {kScatteredRays, 1, 4}}), made_for_it(c, {8, rays, 1});
            for (Bench* b : {&usual, &made_for_it})
                for (int y = 30; y < 45; ++y)
                    for (std::size_t x = 33; x < 47; ++x) b->radiance.row(y)[x] = 1;
            const ElectronImage& other = usual.expose({.exposure_s = 1, .ray_grid = rays});
            const ElectronImage& own = made_for_it.expose({.exposure_s = 1});
            const double full = at(own, 30, 30);
            double most = 0, from_usual = 0;
            for (int y = 0; y < 64; ++y)
                for (int x = 0; x < 64; ++x) most = std::max(most, std::abs(at(other, x, y) - at(own, x, y)));
            EXPECT_LT(most, 1e-4 * full) << rays << ' ' << by_kernel;
            // The usual way is another: the difference would be seen.
            const ElectronImage& as_usual = usual.expose({.exposure_s = 1});
            for (int y = 0; y < 64; ++y)
                for (int x = 0; x < 64; ++x)
                    from_usual = std::max(from_usual, std::abs(at(as_usual, x, y) - at(own, x, y)));
            EXPECT_GT(from_usual, 10e-4 * full) << rays << ' ' << by_kernel;
        }
    }
}

}  // namespace
}  // namespace hilcam
