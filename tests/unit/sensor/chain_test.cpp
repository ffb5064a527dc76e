// The whole chain: extremes, determinism, effects that are off.

#include "sensor/chain.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <functional>

#include "render/vocabulary/check.h"
#include "tests/support/cameras.h"
#include "tests/support/statistics.h"

namespace hilcam {
namespace {

using Frame = std::vector<std::uint16_t>;

// A picture with something in it.
void paint(Bench& bench) {
    for (int y = 0; y < bench.radiance.height(); ++y)
        for (int x = 0; x < bench.radiance.width(); ++x)
            bench.radiance.row(y)[static_cast<std::size_t>(x)] = static_cast<float>((x * 7 + y * 3) % 97);
}
Frame frame_of(Bench& bench, const Exposure& exposure) {
    PointSource star;
    star.position_px = {20.3f, 30.6f};
    star.irradiance_w_m2_um[0] = 1e-7f;
    bench.expose(exposure, {{star}});
    bench.chain.digitise(bench.electrons, exposure, {5, 9}, bench.frame);
    return {bench.frame.all().begin(), bench.frame.all().end()};
}
Frame frame_of(const CameraModel& c) {
    Bench bench(c);
    paint(bench);
    return frame_of(bench, {.exposure_s = 1e-3});
}

CameraModel noisy_camera() {
    CameraModel c = camera_64();
    c.read_noise_e = 5, c.offset_dn = 50, c.dark_current_e_s = 100;
    return c;
}
CameraModel everything() {
    CameraModel c = noisy_camera();
    c.prnu_fraction = 0.02, c.dsnu_e = 5, c.row_noise_e = 2, c.flicker_noise_e = 3, c.reset_noise_e = 2;
    c.fixed_pattern.dark_current_fraction = 0.3, c.fixed_pattern.row_e = 2, c.fixed_pattern.column_e = 2;
    c.defects.hot_fraction = 0.01, c.defects.hot_e_s = 1e4, c.defects.dead_fraction = 0.01;
    c.defects.telegraph_fraction = 0.05, c.defects.telegraph_e = 30;
    c.ccd.blooming = true, c.ccd.parallel_inefficiency = 1e-4, c.ccd.serial_inefficiency = 1e-4;
    c.cosmic_rays.rate_cm2_s = 1e6, c.shutter.kind = ShutterKind::kFrameTransfer;
    c.stray_light.veiling_glare_fraction = 0.01, c.stray_light.ghost_fraction = 0.01;
    c.field_zones = {{0, 0, 0}, {1, 1e-5, 0}};
    c.color_filter = {
        "RG GB", {{"R", Curve::constant(0.8)}, {"G", Curve::constant(0.5)}, {"B", Curve::constant(0.2)}}};
    c.crosstalk_fraction = 0.01, c.nonlinearity = {-0.02, 0.01};
    c.filters = {0.4, 0.001, 0.2};
    c.converter = {2, 0.2, Companding::kSquareRoot};
    c.black_rows = 3, c.black_columns = 5;
    return c;
}

TEST(Chain, ExtremesStayFiniteAndInRange) {
    for (const CameraModel& c : {camera_64(), everything()}) {
        Bench bench(c);
        bench.radiance.row(40)[40] = 1e30f;
        bench.radiance.row(10)[10] = 1e-12f;
        PointSource point;
        point.position_px = {10, 10};
        point.irradiance_w_m2_um[0] = 1e20f;
        for (const double exposure_s : {1e-6, 1000.0}) {
            const Exposure exposure{.exposure_s = exposure_s,
                                    .gain_db = 24,
                                    .image_rate_px_s = {1e3, 1e-3},
                                    .camera_rate_rad_s = {1, 20, -3}};
            const ElectronImage& mean = bench.expose(exposure, {{point}});
            for (const float v : mean.all()) ASSERT_TRUE(v >= 0 && std::isfinite(v));
            bench.chain.digitise(mean, exposure, {1, 1}, bench.frame);
            for (const std::uint16_t v : bench.frame.all()) ASSERT_LE(v, 4095);
        }
    }
}

// A radiance of 1e-12 W m^-2 sr^-1 um^-1 for 1000 s: half a thousandth of an electron, as the closed form has
// it.
TEST(Chain, FaintestAndBrightestLightIsNotBiased) {
    CameraModel c = camera_64();
    c.bits = 16;
    Bench bench(c);
    bench.fill(1e-12f);
    const double faint = static_cast<double>(bench.expose({.exposure_s = 1000}).row(32)[32]);
    bench.fill(1.0f);
    const double bright = static_cast<double>(bench.expose({.exposure_s = 1}).row(32)[32]);
    EXPECT_NEAR(faint / (bright * 1e-9), 1, 1e-5);
    // A mean of 1e6 e-: standard error 1000 / 64 e-.
    c.gain_dn_e = 0.05, c.full_well_e = 1e8;
    Bench strong(c);
    const Moments m = moments_of(strong.digitise_flat(1e6f).all());
    EXPECT_NEAR(m.mean, 5e4, 4 * 0.05 * 1000 / 64);
    EXPECT_NEAR(m.variance, 0.0025 * 1e6, 4 * std::sqrt(2.0 / 4096) * 0.0025 * 1e6);
    // No light and no noise is the black level, exactly.
    c.offset_dn = 17;
    Bench dark(c);
    for (const std::uint16_t v : dark.digitise_flat(0).all()) ASSERT_EQ(v, 17);
}

TEST(Chain, FramesDoNotDependOnTheThreadCount) {
    const auto frame_with = [](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return frame_of(everything());
    };
    EXPECT_EQ(frame_with(1), frame_with(2));
}

// Each effect with its strength at zero, whatever its other figures say, changes no bit.
TEST(Chain, AnEffectThatIsOffLeavesTheFrameAsItIs) {
    const CameraModel base = noisy_camera();
    const Frame expected = frame_of(base);
    const std::vector<std::pair<const char*, std::function<void(CameraModel&)>>> off = {
        {"prnu", [](CameraModel& c) { c.prnu_fraction = 0, c.fixed_pattern.seed = 99; }},
        {"glare", [](CameraModel& c) { c.stray_light.glare_radius_px = 0; }},
        {"ghost", [](CameraModel& c) { c.stray_light.ghost_scale = 2, c.stray_light.ghost_radius_px = 99; }},
        {"hot pixels", [](CameraModel& c) { c.defects.hot_e_s = 1e6; }},
        {"telegraph", [](CameraModel& c) { c.defects.telegraph_e = 1e3, c.defects.telegraph_frames = 3; }},
        {"telegraph of no height", [](CameraModel& c) { c.defects.telegraph_fraction = 0.5; }},
        {"line time of a global shutter", [](CameraModel& c) { c.shutter.line_time_s = 1; }},
        {"cosmic rays", [](CameraModel& c) { c.cosmic_rays.electrons_per_um = 1e4; }},
        {"temperature without dark current", [](CameraModel& c) { c.dark_doubling_k = 3; }},
        {"nonlinearity",
         [](CameraModel& c) {
             c.nonlinearity = {0, 0};
         }},
        {"vignetting",
         [](CameraModel& c) {
             c.vignetting = {{0, 1}, {1, 1}};
         }},
        {"one zone",
         [](CameraModel& c) {
             c.field_zones = {{0.5, 0, 0}};
         }},
        {"black rows of none", [](CameraModel& c) { c.black_rows = 0; }},
        {"whole window",
         [](CameraModel& c) {
             c.window_px = {0, 0, 64, 64};
         }},
        {"principal point in the middle",
         [](CameraModel& c) {
             c.principal_point_px = {32, 32};
         }},
    };
    for (const auto& [name, change] : off) {
        CameraModel c = base;
        change(c);
        EXPECT_EQ(frame_of(c), expected) << name;
    }
    // The comparison can fail.
    CameraModel on = base;
    on.prnu_fraction = 1e-3;
    EXPECT_NE(frame_of(on), expected);
}

// Any pixel of any frame: a window of one pixel shows what the whole frame shows there.
TEST(Chain, APixelCanBeRecomputedAlone) {
    CameraModel c = noisy_camera();
    c.prnu_fraction = 0.05, c.dsnu_e = 20, c.row_noise_e = 3;
    c.fixed_pattern.column_e = 5, c.fixed_pattern.row_e = 5, c.fixed_pattern.dark_current_fraction = 0.5;
    c.defects.hot_fraction = 0.2, c.defects.hot_e_s = 1e5, c.defects.telegraph_fraction = 0.3;
    c.defects.telegraph_e = 40;
    const auto digitise = [](Bench& bench) {
        bench.fill(20);
        const Exposure exposure{.exposure_s = 1e-3};
        bench.chain.digitise(bench.expose(exposure), exposure, {3, 12}, bench.frame);
    };
    Bench whole(c);
    digitise(whole);
    for (const auto& [x, y] : {std::pair{0, 0}, {17, 5}, {40, 63}, {63, 31}}) {
        CameraModel one = c;
        one.window_px = {static_cast<double>(x), static_cast<double>(y), 1, 1};
        Bench bench(one);
        digitise(bench);
        EXPECT_EQ(bench.frame.row(0)[0], whole.frame.row(y)[static_cast<std::size_t>(x)]) << x << ' ' << y;
    }
}

TEST(Chain, WindowBlackPixelsAndBinningGiveTheFrameItsSize) {
    CameraModel c = noisy_camera();
    c.window_px = {10, 20, 30, 21}, c.black_rows = 3, c.black_columns = 4, c.binning_x = 2, c.binning_y = 3;
    EXPECT_EQ(frame_size(c)[0], 17);
    EXPECT_EQ(frame_size(c)[1], 8);
    for (const BinningKind kind : {BinningKind::kCharge, BinningKind::kSum, BinningKind::kMean}) {
        c.binning = kind;
        Bench bench(c);
        bench.fill(50);
        const Exposure exposure{.exposure_s = 1e-3};
        bench.chain.digitise(bench.expose(exposure), exposure, {1, 1}, bench.frame);
        // The first binned row and the first two binned columns are black.
        EXPECT_EQ(bench.frame.width(), 17);
        EXPECT_LT(bench.frame.row(5)[0], bench.frame.row(5)[8]);
        EXPECT_LT(bench.frame.row(0)[8], bench.frame.row(5)[8]);
    }
}

TEST(Chain, BinnedChargeHasOneReadNoiseAndBinnedNumbersHaveManyOfThem) {
    CameraModel c = camera_64();
    c.width_px = c.height_px = 256;
    c.offset_dn = 200, c.read_noise_e = 10, c.binning_x = c.binning_y = 2;
    const auto moments = [&](BinningKind kind) {
        c.binning = kind;
        Bench bench(c);
        return moments_of(bench.digitise_flat(100).all());
    };
    // 16384 pixels: variances to 1.1 %, means to 0.2 e-; four of each.
    const Moments charge = moments(BinningKind::kCharge), sum = moments(BinningKind::kSum),
                  mean = moments(BinningKind::kMean);
    EXPECT_NEAR(charge.mean, 200 + 400, 0.8);
    EXPECT_NEAR(charge.variance, 400 + 100 + 1.0 / 12, 0.045 * 500);
    EXPECT_NEAR(sum.mean, 800 + 400, 0.9);
    EXPECT_NEAR(sum.variance, 4 * (100 + 100 + 1.0 / 12), 0.045 * 800);
    EXPECT_NEAR(mean.mean, 200 + 100, 0.3 + 0.25);  // rounding halves up: at most a quarter of a DN
    EXPECT_NEAR(mean.variance, 50 + 1.0 / 12, 0.05 * 50);
}

// The first pixel's amplifier reads them all.
TEST(Chain, BinnedChargeHasItsFirstPixelsTelegraphNoise) {
    CameraModel c = camera_64();
    c.offset_dn = 200, c.binning_x = 3, c.binning_y = 2;
    c.defects.telegraph_fraction = 0.3, c.defects.telegraph_e = 60, c.defects.telegraph_frames = 1;
    CameraModel single = c;
    single.binning_x = single.binning_y = 1;
    Bench binned(c), bench(single);
    const DnImage& all = bench.digitise_flat(0);
    const DnImage& frame = binned.digitise_flat(0);
    for (int y = 0; y < frame.height(); ++y)
        for (std::size_t x = 0; x < static_cast<std::size_t>(frame.width()); ++x)
            ASSERT_EQ(frame.row(y)[x], all.row(2 * y)[3 * x]);
    EXPECT_GT(moments_of(frame.all()).variance, 0.2 * 900);
}

// 255 sqrt(DN / 4095) of 2 x 2 pixels of 250 DN: of the sum, 1000, and of the mean.
TEST(Chain, BinnedNumbersAreCompandedAfterwards) {
    CameraModel c = camera_64();
    c.offset_dn = 250, c.binning_x = c.binning_y = 2, c.converter.companding = Companding::kSquareRoot;
    for (const auto& [kind, dn] : {std::pair{BinningKind::kSum, 126}, std::pair{BinningKind::kMean, 63}}) {
        c.binning = kind;
        Bench bench(c);
        EXPECT_EQ(bench.digitise_flat(0).row(3)[5], dn);
    }
}

// Four numbers of 12 bits make a sum of 14, which ends at its own width and not at the converter's.
TEST(Chain, SumsHaveAWidthOfTheirOwn) {
    CameraModel c = camera_64();
    c.offset_dn = 3000, c.binning_x = c.binning_y = 2, c.binning = BinningKind::kSum;
    EXPECT_EQ(Bench(c).digitise_flat(0).row(3)[5], 4095);
    EXPECT_EQ(c.frame_bits(), 12);
    c.sum_bits = 14;
    EXPECT_EQ(Bench(c).digitise_flat(0).row(3)[5], 12000);
    EXPECT_EQ(c.frame_bits(), 14);
    c.sum_bits = 13;
    EXPECT_EQ(Bench(c).digitise_flat(0).row(3)[5], 8191);
    // Two columns alone, which an exposure asks for, are of the same width.
    c.sum_bits = 14, c.binning_y = 1;
    EXPECT_EQ(Bench(c).digitise_flat(0).row(3)[5], 6000);
    c.converter.companding = Companding::kTable, c.converter.companding_table = {{0, 16383}, {0, 255}};
    EXPECT_EQ(Bench(c).digitise_flat(0).row(3)[5], 93);  // 6000 / 16383 * 255
    EXPECT_EQ(c.frame_bits(), 8);
}

TEST(Chain, ALargeImageAndAWindowOfOnePixelWork) {
    CameraModel c = noisy_camera();
    c.width_px = c.height_px = 5000;
    Bench bench(c, {4, 1, 1});
    bench.fill(10);
    const Exposure exposure{.exposure_s = 1e-3};
    bench.chain.digitise(bench.expose(exposure), exposure, {1, 1}, bench.frame);
    EXPECT_GT(bench.frame.row(2500)[2500], bench.frame.row(0)[0] / 2);
    EXPECT_NE(bench.frame.row(4999)[4999], 0);
}

TEST(Chain, AFrameTransferCameraSmearsItsColumns) {
    CameraModel c = gaussian_camera(0.4);
    c.shutter.kind = ShutterKind::kFrameTransfer, c.shutter.line_time_s = 1e-5;
    Bench bench(c), still(gaussian_camera(0.4));
    for (Bench* b : {&bench, &still})
        for (int y = 30; y < 40; ++y)
            for (std::size_t x = 30; x < 40; ++x) b->radiance.row(y)[x] = 100;
    const ElectronImage& smeared = bench.expose({.exposure_s = 1e-3});
    const ElectronImage& sharp = still.expose({.exposure_s = 1e-3});
    double column = 0;
    // The square lies at 22 to 32 of the frame.
    for (int y = 0; y < 64; ++y) column += static_cast<double>(sharp.row(y)[26]);
    const double light = static_cast<double>(sharp.row(60)[26]);
    EXPECT_NEAR((static_cast<double>(smeared.row(60)[26]) - light) / ((column - light) * 0.01), 1, 1e-5);
    EXPECT_LT(static_cast<double>(smeared.row(60)[5]), 1e-5 * column);
}

// Each place of a column adds to the smear by its own gain, so all pixels that pass them have the same smear.
TEST(Chain, SmearDoesNotDependOnThePixelThatCarriesIt) {
    CameraModel c = gaussian_camera(0.4);
    c.shutter.kind = ShutterKind::kFrameTransfer, c.shutter.line_time_s = 1e-5;
    c.prnu_fraction = 0.1;
    Bench bench(c);
    for (int y = 30; y < 40; ++y)
        for (std::size_t x = 30; x < 40; ++x) bench.radiance.row(y)[x] = 100;
    const ElectronImage& smeared = bench.expose({.exposure_s = 1e-3});
    const double top = static_cast<double>(smeared.row(2)[26]);
    ASSERT_GT(top, 0);
    for (int y : {4, 7, 50, 60}) EXPECT_NEAR(static_cast<double>(smeared.row(y)[26]) / top, 1, 1e-3) << y;
    double column = 0;
    for (int y = 0; y < 64; ++y) column += static_cast<double>(smeared.row(y)[26]) - top;
    // The lit pixels, with their gains, less what they collect of each other.
    EXPECT_NEAR(top / column, 0.01 / 0.99, 1e-5);
}

}  // namespace
}  // namespace hilcam
