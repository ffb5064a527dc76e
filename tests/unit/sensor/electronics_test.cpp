#include "sensor/electronics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "render/vocabulary/units.h"
#include "sensor/read_out.h"
#include "tests/support/cameras.h"
#include "tests/support/statistics.h"

namespace hilcam {
namespace {

// A sine goes in; what comes out, far from the row's beginning, has the amplitude that mtf() says.
TEST(RowFilter, ActsAsItsTransferFunctionSays) {
    for (const FilterConfig& config : {FilterConfig{0.2, 0, 0}, FilterConfig{0, 0.01, 0},
                                       FilterConfig{0, 0, 0.5}, FilterConfig{0.3, 0.005, 0.4}}) {
        const RowFilter filter(config);
        for (const double f : {0.02, 0.1, 0.25, 0.45}) {
            std::vector<float> row(4000);
            for (std::size_t i = 0; i < row.size(); ++i)
                row[i] = static_cast<float>(1000 * std::sin(2 * kPi * f * static_cast<double>(i)));
            filter.apply(row);
            std::complex<double> sum = 0;
            for (std::size_t i = 2000; i < 3900; ++i)
                sum += static_cast<double>(row[i]) * std::polar(1.0, -2 * kPi * f * static_cast<double>(i));
            // Over 1900 samples the other half of the sine leaves less than 0.3 %.
            EXPECT_NEAR(2 * std::abs(sum) / 1900 / 1000, filter.mtf(f), 4e-3) << f;
        }
    }
    // A one-pole filter is 3 dB down at its frequency, sampled ones nearly.
    EXPECT_NEAR(RowFilter({0.01, 0, 0}).mtf(0.01), std::sqrt(0.5), 1e-3);
    EXPECT_NEAR(RowFilter({0, 0.01, 0}).mtf(0.01), std::sqrt(0.5), 0.03);
    EXPECT_NEAR(RowFilter({0, 0, 0.5}).mtf(0.5), 2, 1e-9);
}

TEST(RowFilter, AFlatRowStaysFlatWithoutHighPass) {
    std::vector<float> row(100, 500.0f);
    RowFilter({0.2, 0, 0.5}).apply(row);
    for (const float v : row) ASSERT_NEAR(v, 500, 1e-3);
}

TEST(Converter, IdealStepsAreRounded) {
    const Converter converter({}, 12, 1);
    const std::vector<float> in = {-5, 0.49f, 0.51f, 1000.4f, 4094.6f, 9e9f};
    std::vector<std::uint16_t> out(in.size());
    converter.convert(in, out);
    EXPECT_THAT(out, testing::ElementsAre(0, 0, 1, 1000, 4095, 4095));
}

// A ramp through all steps: the widths of the steps have the configured deviation, the curve the configured
// bend.
TEST(Converter, StepErrorsAreTheConfigured) {
    const Converter converter({3, 0.1, Companding::kNone}, 10, 7);
    constexpr int kParts = 200;
    std::vector<double> width(1024), middle(1024);
    std::vector<float> in(1);
    std::vector<std::uint16_t> out(1);
    for (int i = 0; i < 1023 * kParts; ++i) {
        in[0] = static_cast<float>(i) / kParts;
        converter.convert(in, out);
        width[out[0]] += 1.0 / kParts, middle[out[0]] += static_cast<double>(in[0]) / kParts;
    }
    const std::vector<double> inner(width.begin() + 10, width.end() - 10);
    // 1000 steps: a deviation to 2.3 %; the bend itself changes widths by 1.2 %, which the ramp's parts
    // round.
    EXPECT_NEAR(std::sqrt(moments_of(inner).variance), 0.1, 0.012);
    // At mid-scale a value reads 3 steps high.
    double deviation = 0;
    for (std::size_t step = 500; step < 530; ++step)
        deviation += (static_cast<double>(step) - middle[step] / width[step]) / 30;
    EXPECT_NEAR(deviation, 3, 0.1);
}

TEST(Converter, SquareRootCompandingKeepsShotNoiseEven) {
    const Converter converter({0, 0, Companding::kSquareRoot}, 12, 1);
    const std::vector<float> in = {0, 16, 1024, 4095};
    std::vector<std::uint16_t> out(in.size());
    converter.convert(in, out);
    converter.compand(out);
    EXPECT_THAT(out, testing::ElementsAre(0, 16, 128, 255));  // 255 sqrt(DN / 4095), rounded
}

// Straight between the table's points and rounded, and as the ends beyond them; the numbers may be sums of more bits than the converter has.
TEST(Converter, ATableCompandsToItsCodes) {
    const Converter converter({0, 0, Companding::kTable, {{0, 100, 4000}, {0, 100, 255}}}, 12, 1, 13);
    std::vector<std::uint16_t> numbers = {0, 7, 100, 2050, 4000, 4095, 8191};
    converter.compand(numbers);
    EXPECT_THAT(numbers, testing::ElementsAre(0, 7, 100, 178, 255, 255, 255));
}

TEST(Converter, ATableThatIsNotUsedOrFallsIsRefused) {
    ConverterConfig c;
    EXPECT_NO_THROW(validate(c));
    c.companding = Companding::kTable;
    EXPECT_THROW(validate(c), KeyError);
    c.companding_table = {{0, 10, 20}, {0, 5, 4}};
    EXPECT_THROW(validate(c), KeyError);
    c.companding_table = {{0, 10, 20}, {0, 5, 5}};
    EXPECT_NO_THROW(validate(c));
    c.companding = Companding::kSquareRoot;
    EXPECT_THROW(validate(c), KeyError);
}

// --- read-out

CameraModel quiet_256() {
    CameraModel c = camera_64();
    c.width_px = c.height_px = 256;
    c.offset_dn = 2000, c.gain_dn_e = 10;
    return c;
}

TEST(ReadOut, RowNoiseIsOneDrawPerRow) {
    CameraModel c = quiet_256();
    c.row_noise_e = 8;
    Bench bench(c);
    const DnImage& frame = bench.digitise_flat(0);
    std::vector<double> rows;
    for (int y = 0; y < 256; ++y) {
        for (const std::uint16_t v : frame.row(y)) ASSERT_EQ(v, frame.row(y)[0]);
        rows.push_back((frame.row(y)[0] - 2000) / 10.0);
    }
    EXPECT_NEAR(std::sqrt(moments_of(rows).variance), 8, 4 * 8 / std::sqrt(512.0));
    const std::uint16_t first = frame.row(0)[0];
    EXPECT_NE(bench.digitise_flat(0, 2).row(0)[0], first);
}

// The periodogram of the array as one series: power per frequency falls as 1/f over four decades, and the
// whole has the configured variance.
TEST(ReadOut, FlickerNoiseHasItsSpectrum) {
    CameraModel c = quiet_256();
    c.flicker_noise_e = 6;
    Bench bench(c);
    double variance = 0;
    std::vector<double> power(17, 0.0);
    constexpr std::uint64_t kFrames = 60;
    for (std::uint64_t f = 1; f <= kFrames; ++f) {
        const DnImage& frame = bench.digitise_flat(0, f);
        std::vector<double> level(frame.all().begin(), frame.all().end());
        for (double& v : level) v = (v - 2000) / 10;
        for (const double v : level) variance += v * v / 65536 / kFrames;
        // Haar: differences of neighbouring means of 2^k have the power of the octave about 2^-k cycles/px.
        for (std::size_t k = 0; k < 12; ++k) {
            for (std::size_t i = 0; i + 1 < level.size(); i += 2) {
                const double d = level[i] - level[i + 1];
                power[k] += d * d / 2 / static_cast<double>(level.size() / 2) / kFrames;
                level[i / 2] = 0.5 * (level[i] + level[i + 1]);
            }
            level.resize(level.size() / 2);
        }
    }
    // 18 shares of 2 e-^2; those of the octaves that are constant over a frame or half of it are drawn only
    // 60 and 120 times: an error of 0.6 in all, four of them.
    EXPECT_NEAR(variance, 36, 2.4);
    // 1/f: every octave has the same power, twice a share. Octave 8 has 7680 differences: to 1.6 %, four of
    // them.
    for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(power[k], 4, 4 * 0.065) << k;
}

TEST(ReadOut, TelegraphPixelsHaveTwoStates) {
    CameraModel c = quiet_256();
    c.defects.telegraph_fraction = 0.01, c.defects.telegraph_e = 30, c.defects.telegraph_frames = 4;
    Bench bench(c);
    std::vector<std::vector<int>> history;
    for (std::uint64_t frame = 1; frame <= 40; ++frame) {
        const DnImage& image = bench.digitise_flat(0, frame);
        history.emplace_back(image.all().begin(), image.all().end());
    }
    double changes = 0, pixels = 0;
    for (std::size_t i = 0; i < history[0].size(); ++i) {
        if (history[0][i] == 2000) {
            for (const auto& frame : history) ASSERT_EQ(frame[i], 2000);
            continue;
        }
        ++pixels;
        for (std::size_t f = 0; f < history.size(); ++f) {
            ASSERT_TRUE(history[f][i] == 2150 || history[f][i] == 1850);
            if (f > 0) changes += history[f][i] != history[f - 1][i];
        }
    }
    EXPECT_NEAR(pixels / 65536, 0.01, 4 * std::sqrt(0.01 / 65536));
    // A new draw every 4 frames, every second of them another state: 39 / 8 changes.
    EXPECT_NEAR(changes / pixels, 39.0 / 8, 0.4);
}

TEST(ReadOut, NonlinearityBendsAsConfigured) {
    CameraModel c = quiet_256();
    c.gain_dn_e = 0.4, c.offset_dn = 0, c.full_well_e = 1e4, c.nonlinearity = {-0.05, 0.02};
    const ReadOut read_out(c);
    for (const float q : {100.0f, 5000.0f, 1e4f}) {
        std::vector<float> charge = {q}, deviate = {0};
        std::vector<std::uint16_t> dn(1);
        read_out.read({0, 0, charge, deviate, {}, 0.4, c.offset_dn}, {}, {1, 1}, dn);
        const double x = static_cast<double>(q) / 1e4;
        EXPECT_NEAR(dn[0], 0.4 * static_cast<double>(q) * (1 - 0.05 * x + 0.02 * x * x), 0.51) << q;
    }
}

TEST(ReadOut, FullWellAndAdcClip) {
    CameraModel c = camera_64();
    c.full_well_e = 1000, c.gain_dn_e = 2, c.offset_dn = 10;
    const auto read = [&](std::vector<float> charge) {
        const std::vector<float> deviates(charge.size());
        std::vector<std::uint16_t> dn(charge.size());
        ReadOut(c).read({0, 0, charge, deviates, {}, c.gain_dn_e, c.offset_dn}, {}, {1, 1}, dn);
        return dn;
    };
    EXPECT_THAT(read({0, 1e6f}), testing::ElementsAre(10, 2010));
    c.gain_dn_e = 100;
    EXPECT_THAT(read({0, 1e6f}), testing::ElementsAre(10, 4095));
}

}  // namespace
}  // namespace hilcam
