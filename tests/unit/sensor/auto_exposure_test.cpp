#include "sensor/auto_exposure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sensor/camera_model.h"

namespace hilcam {
namespace {

// A camera whose percentile is proportional to light and exposure until it saturates; two interleaved series
// of frames as in the loop: frame k sets frame k + 2.
std::vector<double> exposures(const AutoExposureConfig& c, double start_s, int frames, const auto& light) {
    std::vector<double> out = {start_s, start_s};
    for (int k = 0; k + 2 < frames; ++k) {
        const double fraction = std::min(1.0, light(k) * out[static_cast<std::size_t>(k)]);
        out.push_back(
            next_exposure_s(c, {fraction, fraction >= 1}, out[static_cast<std::size_t>(k)], {1e-6, 10}));
    }
    return out;
}

TEST(AutoExposure, AStepOfBrightnessSettlesInTheTimeThatItsSpeedSays) {
    AutoExposureConfig c;
    c.speed = 0.5;
    // Right at first; from frame 10 on eight times as bright.
    const auto e = exposures(c, 0.5, 40, [](int k) { return k < 10 ? 1.0 : 8.0; });
    const double right = 0.5 / 8;
    // Saturated at 0.5, 0.25 and 0.125, where half a stop, half a stop and half a stop are less than the stop
    // that saturation takes: frames 10, 12 and 14 are measured, and frame 16 is right.
    for (std::size_t k = 0; k < 12; ++k) EXPECT_EQ(e[k], 0.5);
    for (std::size_t k = 12; k < e.size(); ++k) {
        EXPECT_LE(e[k], e[k - 2]) << k;             // no way back
        EXPECT_GE(e[k], right * (1 - 1e-12)) << k;  // not beyond
    }
    EXPECT_GT(std::log2(e[14] / right), 0.1);
    EXPECT_NEAR(e[16], right, 1e-12);
    EXPECT_EQ(e[39], e[16]);
}

TEST(AutoExposure, ADarkerSceneIsReachedFromBelow) {
    AutoExposureConfig c;
    c.speed = 0.75;
    const auto e = exposures(c, 0.5, 40, [](int k) { return k < 10 ? 1.0 : 0.125; });
    // Three stops, of which a quarter is left each time: 0.75, 0.19, 0.05.
    for (std::size_t k = 12; k < e.size(); ++k) {
        EXPECT_GE(e[k], e[k - 2]) << k;
        EXPECT_LE(e[k], 4 * (1 + 1e-12)) << k;
    }
    EXPECT_LT(std::log2(e[14] / 4), -0.1);
    EXPECT_GE(std::log2(e[16] / 4), -0.1);
    EXPECT_EQ(e[39], e[17]);
}

TEST(AutoExposure, SaturationHalvesAtLeastAndLimitsHold) {
    AutoExposureConfig c;
    c.speed = 0.1;
    EXPECT_EQ(next_exposure_s(c, {1, true}, 0.4, {1e-6, 10}), 0.2);
    EXPECT_EQ(next_exposure_s(c, {1, true}, 0.4, {0.3, 10}), 0.3);
    EXPECT_EQ(next_exposure_s(c, {-0.01, false}, 0.4, {1e-6, 0.5}), 0.5);
    EXPECT_EQ(next_exposure_s(c, {0.5 * std::exp2(0.09), false}, 0.4, {1e-6, 10}), 0.4);
    EXPECT_LT(next_exposure_s(c, {0.5 * std::exp2(0.11), false}, 0.4, {1e-6, 10}), 0.4);
}

TEST(FrameHistogram, FindsThePercentileAboveBlackOutsideTheBlackPixels) {
    DnImage frame(10, 11);
    for (int y = 0; y < 11; ++y)
        for (int x = 0; x < 10; ++x)
            // 90 pixels 101 .. 190 behind a column and a row of others.
            frame.row(y)[static_cast<std::size_t>(x)] =
                static_cast<std::uint16_t>(y < 1 || x < 1 ? 4095 : 100 + (y - 1) * 9 + x);
    FrameHistogram histogram(12);
    const DnScale scale{100, 300, 4095, false};
    EXPECT_DOUBLE_EQ(histogram.measure(frame, 1, 1, 50, scale).fraction, 45 / 200.0);
    EXPECT_DOUBLE_EQ(histogram.measure(frame, 1, 1, 99, scale).fraction, 90 / 200.0);  // the 89.1th
    EXPECT_FALSE(histogram.measure(frame, 1, 1, 99, scale).saturated);
    EXPECT_TRUE(histogram.measure(frame, 0, 0, 99, scale).saturated);
    EXPECT_TRUE(histogram.measure(frame, 1, 1, 99, {100, 190, 4095, false}).saturated);
}

Exposure at_gain(double gain_db) { return {1e-3, gain_db}; }

TEST(AutoExposure, FullScaleIsWhereTheCameraSaturates) {
    CameraModel c;
    c.gain_dn_e = 0.1;
    c.full_well_e = 20000;
    c.offset_dn = 60;
    EXPECT_EQ(dn_scale_of(c, at_gain(0)).full_dn, 2060);   // the well
    EXPECT_EQ(dn_scale_of(c, at_gain(20)).full_dn, 4095);  // ten times the gain: the converter
    EXPECT_EQ(dn_scale_of(c, at_gain(0)).black_dn, 60);
    c.binning_x = 2;
    EXPECT_EQ(dn_scale_of(c, at_gain(0)).full_dn, 4060);  // two wells
    c.binning = BinningKind::kSum;
    EXPECT_EQ(dn_scale_of(c, at_gain(0)).full_dn, 4095);
    EXPECT_EQ(dn_scale_of(c, at_gain(0)).black_dn, 120);
    c.sum_bits = 14;
    EXPECT_EQ(dn_scale_of(c, at_gain(0)).full_dn, 4120);
    EXPECT_EQ(dn_scale_of(c, at_gain(20)).full_dn, 8190);
    c.sum_bits = 0;
    c.binning = BinningKind::kMean;
    EXPECT_EQ(dn_scale_of(c, at_gain(0)).full_dn, 2060);
    EXPECT_EQ(dn_scale_of(c, at_gain(0)).black_dn, 60);
    c.nonlinearity = {-0.1, 0.05};
    EXPECT_DOUBLE_EQ(dn_scale_of(c, at_gain(0)).full_dn, 1960) << "read as less than it is";
}

// A code of a table stands for the middle of the numbers that have it.
TEST(AutoExposure, CodesOfATableAreUndone) {
    CameraModel c;
    c.gain_dn_e = 0.1, c.full_well_e = 1e6, c.offset_dn = 0, c.bits = 12;
    c.converter.companding = Companding::kTable;
    c.converter.companding_table = {{0, 100, 3000, 4095}, {0, 100, 200, 200}};
    FrameHistogram histogram(8);
    DnImage frame(10, 10);
    const auto fraction = [&](std::uint16_t code) {
        for (std::uint16_t& dn : frame.all()) dn = code;
        return histogram.measure(frame, 0, 0, 50, dn_scale_of(c, at_gain(0))).fraction;
    };
    EXPECT_NEAR(fraction(50), 50 / 4095.0, 1e-9);
    EXPECT_NEAR(fraction(150), 1550 / 4095.0, 1e-9);
    EXPECT_NEAR(fraction(200), 1, 1e-9);  // the last code goes to the table's end
}

}  // namespace
}  // namespace hilcam
