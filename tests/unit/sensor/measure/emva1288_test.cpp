// Frames of a made-up camera whose figures are known: they come back within their own uncertainties.
//
// Four standard errors: a right program fails one of them with a chance of 6e-5, all of this file's fifty
// with 0.3 %; the draws are fixed, so it either does or does not. Each test also shows a wrong figure to lie
// outside.

#include "sensor/measure/emva1288.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "sensor/noise.h"

namespace hilcam {
namespace {

constexpr double kSigmas = 4;

void expect_within(const Measured& m, double truth, double wrong) {
    EXPECT_NEAR(m.value, truth, kSigmas * m.uncertainty);
    EXPECT_GT(std::abs(m.value - wrong), kSigmas * m.uncertainty) << "cannot tell " << wrong;
}

double normal(std::uint64_t seed, std::uint64_t frame, std::uint32_t pixel) {
    return static_cast<double>(
        normal_quantile(uniform01(random_words({seed, frame}, RandomPurpose::kPathSample, pixel)[0])));
}

struct MadeUpCamera {
    int width = 200, height = 200;
    double gain_dn_e = 0.4, efficiency = 0.6, full_well_e = 8000, offset_dn = 50, max_dn = 4095;
    double read_noise_e = 6, row_noise_e = 0;
    double prnu = 0, row_gain = 0, column_gain = 0, dsnu_e = 0, row_e = 0, column_e = 0;
    double bend = 0;     // charge q is read as q (1 + bend q / full well)
    double shading = 0;  // light at the corners is less by so much
    double dark_e_s = 0;
    double filter = 0;  // a row's sample keeps this share of the one before
    std::uint64_t seed = 1;
    mutable std::uint64_t frames = 0;

    double pattern(int x, int y, double pixel, double row, double column, std::uint64_t what) const {
        return pixel * normal(what, 0, static_cast<std::uint32_t>(y * width + x)) +
               row * normal(what, 1, static_cast<std::uint32_t>(y)) +
               column * normal(what, 2, static_cast<std::uint32_t>(x));
    }
    double light(int x, int y) const {
        const double u = 2.0 * x / width - 1, v = 2.0 * y / height - 1;
        return 1 - shading * 0.5 * (u * u + v * v);
    }
    DnImage frame(double photons, double exposure_s = 0) const {
        ++frames;
        DnImage out(width, height);
        std::vector<float> mean(static_cast<std::size_t>(width)), charge(mean.size()), deviate(mean.size());
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x)
                mean[static_cast<std::size_t>(x)] =
                    static_cast<float>(photons * efficiency * light(x, y) *
                                           (1 + pattern(x, y, prnu, row_gain, column_gain, 11)) +
                                       dark_e_s * exposure_s);
            draw_pixels(mean, {seed, frames}, static_cast<std::uint32_t>(y * width), charge, deviate);
            const double of_row = row_noise_e * normal(seed, frames, static_cast<std::uint32_t>(y));
            double before = 0;
            for (int x = 0; x < width; ++x) {
                const auto i = static_cast<std::size_t>(x);
                const double q = std::min(static_cast<double>(charge[i]), full_well_e);
                double value = q * (1 + bend * q / full_well_e) +
                               read_noise_e * static_cast<double>(deviate[i]) + of_row +
                               pattern(x, y, dsnu_e, row_e, column_e, 12);
                if (x > 0) value = filter * before + (1 - filter) * value;
                before = value;
                out.row(y)[i] = static_cast<std::uint16_t>(
                    std::lround(std::clamp(value * gain_dn_e + offset_dn, 0.0, max_dn)));
            }
        }
        return out;
    }
    PixelSelection all() const { return {0, 0, width, height}; }
    TemporalStatistics pairs(const PixelSelection& selection, int count, double photons,
                             double exposure_s = 0) const {
        PairSeries series(selection);
        for (int i = 0; i < count; ++i) {
            const DnImage first = frame(photons, exposure_s);
            series.add(first, frame(photons, exposure_s));
        }
        return series.result();
    }
    std::vector<LightPoint> light_series(int levels = 20) const {
        const PixelSelection selection = all();
        std::vector<LightPoint> out;
        for (int i = 1; i <= levels; ++i) {
            LightPoint point;
            point.photons = 1.1 * full_well_e / efficiency * i / levels;
            point.light = pairs(selection, 2, point.photons);
            point.dark = pairs(selection, 2, 0);
            out.push_back(point);
        }
        return out;
    }
    struct Stack {
        FrameStack frames;
        TemporalStatistics temporal;
    };
    Stack stack(const PixelSelection& selection, double photons, int count = 32) const {
        Stack out{FrameStack(selection), {}};
        PairSeries series(selection);
        for (int i = 0; i < count / 2; ++i) {
            const DnImage a = frame(photons), b = frame(photons);
            out.frames.add(a), out.frames.add(b), series.add(a, b);
        }
        out.temporal = series.result();
        return out;
    }
};

double saturation_dn(const std::vector<LightPoint>& points) {
    return points[saturation_index(points)].signal_dn();
}

TEST(Emva1288, GainAndResponsivityOfAStraightCamera) {
    const MadeUpCamera camera;
    const std::vector<LightPoint> points = camera.light_series();
    // The last level before the full well: 8 % apart.
    EXPECT_NEAR(saturation_dn(points) / (camera.gain_dn_e * camera.full_well_e), 0.96, 0.04);
    const PhotonTransfer standard = photon_transfer(points, saturation_dn(points));
    expect_within(standard.gain_dn_e, 0.4, 0.404);
    expect_within(standard.responsivity_dn_photon, 0.24, 0.2403);
    const ResponseCurve response(points, saturation_dn(points));
    expect_within(small_signal_gain_dn_e(points, response, saturation_dn(points)), 0.4, 0.408);
    expect_within(response.responsivity_dn_photon(), 0.24, 0.2405);
    EXPECT_NEAR(response.photons(response.signal_dn(5000)), 5000, 1e-6);
}

// To first order the variance is K y (1 + 3 a x) at a share x of full scale; a line through the origin up to
// 0.7 then has the slope K (1 + 3 a 0.7 3/4). That of small signals is K.
TEST(Emva1288, GainOfACameraThatBends) {
    MadeUpCamera camera;
    camera.bend = -0.03;
    const std::vector<LightPoint> points = camera.light_series();
    const Measured standard = photon_transfer(points, saturation_dn(points)).gain_dn_e;
    EXPECT_NEAR(standard.value / 0.4, 1 - 1.575 * 0.03, 0.03 * 0.2);
    const ResponseCurve response(points, saturation_dn(points));
    expect_within(small_signal_gain_dn_e(points, response, saturation_dn(points)), 0.4, standard.value);
}

// Sixteen cameras that differ by chance alone: their gains scatter by the stated uncertainty. A variance of
// 16 values is known to 2/15: 37 %, the deviation to 18 %; three of that.
TEST(Emva1288, GainsScatterByTheirUncertainty) {
    double square = 0, stated = 0;
    constexpr int kCameras = 16;
    for (int i = 0; i < kCameras; ++i) {
        MadeUpCamera camera;
        camera.width = camera.height = 60;
        camera.seed = 100 + static_cast<std::uint64_t>(i);
        const std::vector<LightPoint> points = camera.light_series(12);
        const Measured gain = photon_transfer(points, saturation_dn(points)).gain_dn_e;
        square += std::pow(gain.value - 0.4, 2) / kCameras;
        stated += gain.uncertainty / kCameras;
    }
    EXPECT_NEAR(std::sqrt(square) / stated, 1, 0.54);
}

TEST(Emva1288, DarkNoiseWithoutRoundingAndWithRowNoise) {
    MadeUpCamera camera;
    const Measured gain{camera.gain_dn_e, 0};
    const TemporalStatistics plain = camera.pairs(camera.all(), 8, 0);
    EXPECT_EQ(plain.row_dn2, 0);
    // Rounding left in would be 0.5 % more; 320,000 differences know the deviation to 0.13 %.
    expect_within(dark_noise_e(plain, 0, gain), 6, 6.06);
    camera.row_noise_e = 4;
    const TemporalStatistics rows = camera.pairs(camera.all(), 16, 0);
    // 200 rows of 16 pairs: the part is known to sqrt(2 / 3200) = 2.5 %.
    EXPECT_NEAR(rows.row_dn2 / (0.16 * 16), 1, 0.1);
    expect_within(dark_noise_e(rows, 0, gain), std::hypot(6, 4), 6);
}

// Noise of 0.32 DN: rounding swallows or doubles it, whatever the black level. With a dark signal it shows.
TEST(Emva1288, SmallDarkNoiseIsFoundUnderADarkSignal) {
    MadeUpCamera camera;
    camera.gain_dn_e = 0.05;
    camera.dark_e_s = 400;
    const Measured gain{camera.gain_dn_e, 0};
    const TemporalStatistics brief = camera.pairs(camera.all(), 4, 0);
    EXPECT_GT(dark_noise_e(brief, 0, gain).uncertainty, 6);
    const TemporalStatistics lasting = camera.pairs(camera.all(), 32, 0, 1);
    expect_within(dark_noise_e(lasting, 400 * camera.gain_dn_e, gain), 6, 7);
}

TEST(Emva1288, DarkCurrentFromMeanAndVariance) {
    MadeUpCamera camera;
    camera.dark_e_s = 120;
    std::vector<DarkPoint> points;
    for (const double exposure_s : {0.0, 0.5, 1.0, 1.5, 2.0})
        points.push_back({exposure_s, camera.pairs(camera.all(), 4, 0, exposure_s)});
    const DarkCurrent current = dark_current_e_s(points, {camera.gain_dn_e, 0});
    expect_within(current.from_mean_e_s, 120, 120.5);
    expect_within(current.from_variance_e_s, 120, 125);
    EXPECT_NEAR(current.offset_dn, 50, 0.05);
}

TEST(Emva1288, NonuniformityIsSplitIntoRowsColumnsAndPixels) {
    MadeUpCamera camera;
    camera.prnu = 0.01, camera.row_gain = 0.004, camera.column_gain = 0.006;
    camera.dsnu_e = 8, camera.row_e = 3, camera.column_e = 5;
    camera.shading = 0.2;
    const PixelSelection selection = camera.all();
    const MadeUpCamera::Stack flat = camera.stack(selection, 6000), dark = camera.stack(selection, 0);
    const Nonuniformity prnu =
        prnu_fraction(flat.frames, flat.temporal, dark.frames, dark.temporal, selection);
    expect_within(prnu.pixel, 0.01, 0.0105);
    // Of 200 rows or columns a deviation is known to 5 %.
    expect_within(prnu.row, 0.004, 0.006);
    expect_within(prnu.column, 0.006, 0.004);
    const Nonuniformity dsnu = dsnu_e(dark.frames, dark.temporal, selection, {camera.gain_dn_e, 0});
    expect_within(dsnu.pixel, 8, 8.4);
    expect_within(dsnu.row, 3, 5);
    expect_within(dsnu.column, 5, 3);
    EXPECT_NEAR(std::pow(dsnu.total.value, 2),
                std::pow(dsnu.pixel.value, 2) + std::pow(dsnu.row.value, 2) + std::pow(dsnu.column.value, 2),
                1e-6);
}

TEST(Emva1288, NothingIsFoundWhereThereIsNothing) {
    MadeUpCamera camera;
    camera.shading = 0.2;
    const PixelSelection selection = camera.all();
    const MadeUpCamera::Stack flat = camera.stack(selection, 6000), dark = camera.stack(selection, 0);
    const Nonuniformity prnu =
        prnu_fraction(flat.frames, flat.temporal, dark.frames, dark.temporal, selection);
    for (const Measured* part : {&prnu.total, &prnu.row, &prnu.column, &prnu.pixel})
        EXPECT_LE(part->value, kSigmas * std::max(part->uncertainty, 1e-4));
}

// y = x - 0.1 x^2 at the 18 levels from 5 to 95 % of 0.9, weights 1/y^2: the line, its deviations and their
// mean magnitude from an independent calculation (numpy.polyfit with w = 1/y).
TEST(Emva1288, LinearityErrorOfAParabola) {
    std::vector<ResponsePoint> points;
    for (int i = 1; i <= 20; ++i) {
        const double x = 0.05 * i;
        points.push_back({x, x - 0.1 * x * x, 0});
    }
    const Linearity found = linearity(points, 0.9);
    EXPECT_EQ(found.points.size(), 18u);
    EXPECT_NEAR(found.error_fraction.value, 0.0167598946, 1e-9);
    EXPECT_NEAR(found.min_fraction, -0.0318296201, 1e-9);
    EXPECT_NEAR(found.max_fraction, 0.0244328421, 1e-9);
}

TEST(Emva1288, DefectsAreCountedAndLeftOut) {
    MadeUpCamera camera;
    PixelSelection selection = camera.all();
    FrameStack stack(selection);
    for (int i = 0; i < 16; ++i) {
        DnImage frame = camera.frame(0);
        frame.row(17)[23] = 900, frame.row(99)[3] = 20;
        stack.add(frame);
    }
    EXPECT_EQ(exclude_outliers(stack.mean_dn(), 6, selection), 2u);
    EXPECT_EQ(selection.count(), 39998u);
    EXPECT_FALSE(selection.use[17 * 200 + 23]);
    // With them, the noise would be another.
    EXPECT_GT(spatial_parts(stack.mean_dn(), camera.all()).total,
              10 * spatial_parts(stack.mean_dn(), selection).total);
}

// y = a y_before + (1 - a) x leaves (1 - a) / (1 + a) of white noise.
TEST(Emva1288, NoiseBandwidthOfARowFilter) {
    MadeUpCamera camera;
    camera.filter = 0.3;
    double mean = 0;
    constexpr int kPairs = 24;
    for (int i = 0; i < kPairs; ++i) {
        const DnImage a = camera.frame(6000), b = camera.frame(6000);
        mean += noise_sums(a, b, camera.all(), {8, 0}).bandwidth() / kPairs;
    }
    // 17 covariances of 40,000 pixels and 24 pairs: sqrt(17 / 960000) = 0.4 % of the variance, over 0.54.
    EXPECT_NEAR(mean, 0.7 / 1.3, 4 * 0.004);
    camera.filter = 0;
    EXPECT_NEAR(noise_sums(camera.frame(6000), camera.frame(6000), camera.all(), {8, 3}).bandwidth(), 1,
                0.25);
}

TEST(Emva1288, WhatFollows) {
    // Hand: sqrt(3^2 + 1/(12 0.5^2)) + 0.5 = 3.5551; 20 log10(10000 / 3.5551) = 68.983; 10 log10 10000 = 40.
    const Measured threshold = absolute_threshold_e({3, 0.1}, {0.5, 0});
    EXPECT_NEAR(threshold.value, 3.5550505, 1e-6);
    EXPECT_NEAR(dynamic_range_db({10000, 0}, threshold).value, 68.9829, 1e-3);
    EXPECT_NEAR(snr_max_db({10000, 0}).value, 40, 1e-12);
}

}  // namespace
}  // namespace hilcam
