#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "render/check.h"
#include "render/stars.h"
#include "render/units.h"
#include "sensor/chain.h"
#include "sensor/mtf.h"
#include "sensor/noise.h"
#include "sensor/optics.h"
#include "sensor/read_out.h"

namespace hilcam {
namespace {

CameraModel camera_64() {
    CameraModel c;
    c.width_px = c.height_px = 64;
    c.focal_length_m = 0.05;
    c.f_number = 4;
    c.bits = 12;
    c.gain_dn_e = 1;
    c.full_well_e = 1e6;
    return c;
}

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

// Electrons of a uniform field, on the axis: L A Omega T QE t dlambda lambda / (h c), one narrow bin.
TEST(Chain, UniformFieldGivesTheClosedFormElectrons) {
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
    EXPECT_NEAR(mean.row(32)[32] / expected, 1, 1e-5);
}

TEST(Chain, FalloffIsCosineToTheFourth) {
    CameraModel c = camera_64();
    c.focal_length_m = 0.0005;  // 64 px are 39 degrees off the axis in the corner
    const SpectralGrid grid({0.5, 0.6});
    SensorChain chain(c, grid, {8, 1, 1});
    RadianceImage radiance(80, 80, 1);
    for (float& v : radiance.all()) v = 1;
    ElectronImage mean(64, 64);
    chain.expose(radiance, {}, {.exposure_s = 1}, mean);
    const double tangent = 31.5 * 5.5e-6 / 0.0005;
    const double cosine4 = std::pow(1 / (1 + tangent * tangent), 2);
    const double tangent_middle = std::hypot(0.5, 0.5) * 5.5e-6 / 0.0005;
    // The optics blur the falloff's curvature a little.
    EXPECT_NEAR(mean.row(31)[63] / mean.row(31)[31],
                cosine4 * std::pow(1 + tangent_middle * tangent_middle, 2), 2e-3);
}

TEST(Chain, PointKeepsItsElectronsAndCentroidWhereverItFalls) {
    CameraModel c = camera_64();
    c.f_number = 11;  // well sampled
    const SpectralGrid grid({0.5, 0.6});
    SensorChain chain(c, grid, {8, 1, 1});
    RadianceImage radiance(80, 80, 1);
    PointSource point;
    point.irradiance_w_m2_um[0] = 1e-6f;
    const double expected = static_cast<double>(electrons_per_s_per_irradiance(c, grid)[0]) * 1e-6;
    for (const double offset : {0.0, 0.13, 0.5, 0.77, 0.999}) {
        point.position_px = {static_cast<float>(32 + offset), static_cast<float>(31.5 + 0.3 * offset)};
        ElectronImage mean(64, 64);
        chain.expose(radiance, std::span(&point, 1), {.exposure_s = 1}, mean);
        const auto px = static_cast<double>(point.position_px.x);
        const auto py = static_cast<double>(point.position_px.y);
        double sum = 0, weights = 0, x = 0, y = 0;
        for (int j = 0; j < 64; ++j)
            for (int i = 0; i < 64; ++i) {
                const double v = static_cast<double>(mean.row(j)[static_cast<std::size_t>(i)]);
                sum += v;
                // The Airy pattern's wings have no centroid of their own; a window round the point has.
                const double dx = i + 0.5 - px, dy = j + 0.5 - py;
                const double w = v * std::exp(-(dx * dx + dy * dy) / (2 * 3.0 * 3.0));
                weights += w, x += w * dx, y += w * dy;
            }
        // At f/11 2 % of the Airy pattern lies farther than 30 px; cos(theta) is 1 within 1e-6.
        EXPECT_NEAR(sum / expected, 1, 0.02) << offset;
        EXPECT_NEAR(x / weights, 0, 1e-3) << offset;
        EXPECT_NEAR(y / weights, 0, 1e-3) << offset;
    }
}

// From a star's magnitude to electrons: V = 2 through an aperture of 20 mm, 90 % of glass and 50 % of quanta,
// 100 ms, in a bin of 10 nm at 0.55 um. 3.63e-8 W m^-2 um^-1 10^(-0.4 2) 0.01 um, photons of 3.6117e-19 J:
// 2,250 e- or so.
TEST(Chain, AStarsMagnitudeBecomesItsElectrons) {
    CameraModel c;
    c.width_px = c.height_px = 64;
    c.pitch_m = 5e-6, c.focal_length_m = 0.08, c.f_number = 4;
    c.transmission = Curve::constant(0.9), c.quantum_efficiency = Curve::constant(0.5);
    c.full_well_e = 1e9;
    const SpectralGrid grid({0.545, 0.555});
    const double watts_m2 = 3.63e-8 * std::pow(10.0, -0.8) * 0.01;
    const double photon_j = 6.62607015e-34 * 299792458.0 / 0.55e-6;
    const double expected = watts_m2 * kPi * 0.01 * 0.01 * 0.9 * 0.5 * 0.1 / photon_j;
    SensorChain chain(c, grid, {8, 1, 1});
    RadianceImage dark(80, 80, 1);
    ElectronImage electrons(64, 64);
    PointSource star;
    star.position_px = {32.3f, 31.8f};
    star.irradiance_w_m2_um = star_irradiance_w_m2_um(2, 0, grid);
    chain.expose(dark, {{star}}, {.exposure_s = 0.1}, electrons);
    double sum = 0;
    for (const float e : electrons.all()) sum += e;
    // The diffraction pattern's far rings leave the picture.
    EXPECT_NEAR(sum / expected, 1, 0.02);
}

TEST(Chain, LightFromOneEdgeDoesNotComeBackAtTheOther) {
    const CameraModel c = camera_64();
    const SpectralGrid grid({0.5, 0.6});
    SensorChain chain(c, grid, {16, 1, 1});
    RadianceImage radiance(96, 96, 1);
    for (int y = 0; y < 96; ++y) radiance.row(y)[16] = 1e6f;  // the frame's first column
    ElectronImage mean(64, 64);
    chain.expose(radiance, {}, {.exposure_s = 1e-3}, mean);
    EXPECT_LT(mean.row(32)[63], 1e-3 * static_cast<double>(mean.row(32)[0]));
}

TEST(Chain, ExtremesStayFiniteAndNotNegative) {
    const CameraModel c = camera_64();
    const SpectralGrid grid({0.5, 0.6});
    SensorChain chain(c, grid, {8, 1, 1});
    RadianceImage radiance(80, 80, 1);
    radiance.row(40)[40] = 1e30f;
    PointSource point{{10, 10}, {}};
    point.irradiance_w_m2_um[0] = 1e20f;
    ElectronImage mean(64, 64);
    DnImage frame(64, 64);
    for (const double exposure_s : {1e-6, 1000.0}) {
        chain.expose(radiance, std::span(&point, 1), {.exposure_s = exposure_s}, mean);
        for (const float v : mean.all()) ASSERT_TRUE(v >= 0 && std::isfinite(v));
        chain.digitise(mean, {.gain_db = 24}, {1, 1}, frame);
        for (const std::uint16_t v : frame.all()) ASSERT_LE(v, 4095);
    }
}

TEST(Chain, FramesDoNotDependOnTheThreadCount) {
    const auto frame_with = [](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const SpectralGrid grid({0.5, 0.6});
        SensorChain chain(camera_64(), grid, {8, 1, 1});
        RadianceImage radiance(80, 80, 1);
        for (int i = 0; i < 6400; ++i)
            radiance.all()[static_cast<std::size_t>(i)] = static_cast<float>(i % 97);
        ElectronImage mean(64, 64);
        DnImage frame(64, 64);
        chain.expose(radiance, {}, {.exposure_s = 1e-3}, mean);
        chain.digitise(mean, {.gain_db = 0}, {5, 9}, frame);
        return std::vector<std::uint16_t>(frame.all().begin(), frame.all().end());
    };
    EXPECT_EQ(frame_with(1), frame_with(2));
}

// --- noise
// ---------------------------------------------------------------------------------------------------------

struct Moments {
    double mean, variance;
};
Moments electrons(float mean_e, float read_noise_e, std::size_t count) {
    const std::vector<float> in(count, mean_e);
    std::vector<float> charge(count), deviates(count);
    draw_pixels(in, {3, 4}, 0, charge, deviates);
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double e = static_cast<double>(charge[i] + read_noise_e * deviates[i]);
        sum += e, squares += e * e;
    }
    const double n = static_cast<double>(count);
    return {sum / n, (squares - sum * sum / n) / (n - 1)};
}

TEST(Noise, ShotNoiseHasPoissonsMeanAndVarianceAtEveryLevel) {
    constexpr std::size_t kCount = 400000;
    for (const float mean : {0.01f, 0.5f, 3.0f, 20.0f, 31.9f, 32.0f, 100.0f, 5000.0f}) {
        const Moments m = electrons(mean, 0, kCount);
        const double lambda = static_cast<double>(mean), n = kCount;
        // 4.5 standard errors of 16 figures: one false alarm in 10^4 runs. Var of a Poisson variance: (2 l^2
        // + l)/n.
        EXPECT_NEAR(m.mean, lambda, 4.5 * std::sqrt(lambda / n) + 1e-3) << mean;
        EXPECT_NEAR(m.variance, lambda, 4.5 * std::sqrt((2 * lambda * lambda + lambda) / n) + 0.003 * lambda)
            << mean;
    }
}

// Chi-square over the counts of a Poisson of mean 4, and the same statistic for a wrong model, which it must
// refuse.
TEST(Noise, SmallCountsFollowPoissonsDistribution) {
    constexpr std::size_t kCount = 100000;
    const auto chi_square = [&](double model_mean) {
        const std::vector<float> in(kCount, 4.0f);
        std::vector<float> out(kCount);
        draw_pixels(in, {11, 2}, 0, out, {});
        std::array<double, 12> seen{};
        for (const float v : out) seen[std::min(static_cast<std::size_t>(v), std::size_t{11})] += 1;
        double statistic = 0, left = 1, probability = std::exp(-model_mean);
        for (std::size_t k = 0; k < 12; ++k) {
            const double expected = kCount * (k == 11 ? left : probability);
            statistic += (seen[k] - expected) * (seen[k] - expected) / expected;
            left -= probability;
            probability *= model_mean / static_cast<double>(k + 1);
        }
        return statistic;
    };
    // 11 degrees of freedom: 31.3 is exceeded once in 1000.
    EXPECT_LT(chi_square(4.0), 31.3);
    EXPECT_GT(chi_square(4.05), 31.3);
}

TEST(Noise, ReadNoiseAddsItsVariance) {
    constexpr double n = 400000;
    const Moments m = electrons(0, 10, 400000);
    EXPECT_NEAR(m.mean, 0, 4 * 10 / std::sqrt(n) + 1e-3);
    EXPECT_NEAR(m.variance, 100, 4 * 100 * std::sqrt(2 / n));
}

TEST(Noise, QuantileMatchesTheTable) {
    // Abramowitz & Stegun, table 26.1.
    EXPECT_NEAR(normal_quantile(0.5f), 0, 1e-6);
    EXPECT_NEAR(normal_quantile(0.975f), 1.959964, 1e-4);
    EXPECT_NEAR(normal_quantile(0.001349898f), -3.0, 1e-3);
    EXPECT_NEAR(normal_quantile(2.866516e-7f), -5.0, 1e-2);
}

TEST(ReadOut, FullWellAndAdcClip) {
    CameraModel c = camera_64();
    c.full_well_e = 1000, c.gain_dn_e = 2, c.offset_dn = 10;
    const auto read = [&](std::vector<float> charge) {
        const std::vector<float> deviates(charge.size());
        std::vector<std::uint16_t> dn(charge.size());
        ReadOut(c).read({0, 0, charge, deviates, {}, c.gain_dn_e}, {}, {1, 1}, dn);
        return dn;
    };
    EXPECT_THAT(read({0, 1e6f}), testing::ElementsAre(10, 2010));
    c.gain_dn_e = 100;
    EXPECT_THAT(read({0, 1e6f}), testing::ElementsAre(10, 4095));
}

TEST(Noise, APixelCanBeRecomputedAlone) {
    std::vector<float> in(300, 50.0f), all(300), deviates(300), one(1), deviate(1);
    in[0] = NAN;
    for (const std::uint32_t first : {1000u, 1001u}) {
        draw_pixels(in, {7, 8}, first, all, deviates);
        EXPECT_EQ(all[0], 0);
        for (const std::uint32_t i : {1u, 2u, 127u, 128u, 298u, 299u}) {
            draw_pixels(std::span(in).subspan(i, 1), {7, 8}, first + i, one, deviate);
            EXPECT_EQ(all[i], one[0]) << first << ' ' << i;
            EXPECT_EQ(deviates[i], deviate[0]) << first << ' ' << i;
        }
    }
}

TEST(CameraModel, RefusesWhatContradictsItself) {
    CameraModel c = camera_64();
    c.exposure_s = 100;
    EXPECT_THROW(validate(c), InputError);
    c = camera_64();
    c.offset_dn = 5000;
    EXPECT_THROW(validate(c), InputError);
}

}  // namespace
}  // namespace hilcam
