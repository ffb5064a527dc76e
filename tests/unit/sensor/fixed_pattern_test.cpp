#include "sensor/fixed_pattern.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/check.h"
#include "tests/support/cameras.h"
#include "tests/support/statistics.h"

namespace hilcam {
namespace {

CameraModel camera_256() {
    CameraModel c = camera_64();
    c.width_px = c.height_px = 256;
    return c;
}
std::vector<double> values(const PixelMap& map) { return {map.all().begin(), map.all().end()}; }

// 65536 pixels: a standard deviation to 0.28 %, Kolmogorov's statistic for the shape.
TEST(FixedPattern, GainsAndOffsetsAreNormalWithTheConfiguredDeviations) {
    CameraModel c = camera_256();
    c.prnu_fraction = 0.013, c.dsnu_e = 7;
    const FixedPattern p = draw_fixed_pattern(c, {});
    EXPECT_LT(kolmogorov(values(p.gain), [](double g) { return normal_cdf((g - 1) / 0.013); }),
              kKolmogorov_1_in_1000);
    EXPECT_LT(kolmogorov(values(p.offset_e), [](double e) { return normal_cdf(e / 7); }),
              kKolmogorov_1_in_1000);
    EXPECT_GT(kolmogorov(values(p.gain), [](double g) { return normal_cdf((g - 1) / 0.0134); }),
              kKolmogorov_1_in_1000);
    EXPECT_NEAR(std::sqrt(moments_of(values(p.gain)).variance), 0.013, 0.011 * 0.013);
    // Gain and offset of a pixel have nothing to do with each other: correlation below 4 / sqrt n.
    double product = 0;
    for (std::size_t i = 0; i < 65536; ++i)
        product +=
            (static_cast<double>(p.gain.all()[i]) - 1) / 0.013 * static_cast<double>(p.offset_e.all()[i]) / 7;
    EXPECT_LT(std::abs(product / 65536), 4.0 / 256);
    EXPECT_EQ(p.dark_e_s.width(), 0);
}

TEST(FixedPattern, RowsAndColumnsHaveTheirOwn) {
    CameraModel c = camera_256();
    c.fixed_pattern.row_e = 3, c.fixed_pattern.column_e = 5;
    const FixedPattern p = draw_fixed_pattern(c, {});
    std::vector<double> rows(256), columns(256);
    for (int y = 0; y < 256; ++y)
        for (std::size_t x = 0; x < 256; ++x) {
            const double e = static_cast<double>(p.offset_e.row(y)[x]) / 256;
            rows[static_cast<std::size_t>(y)] += e, columns[x] += e;
        }
    // 256 draws: a standard deviation to 4.4 %; four of them.
    EXPECT_NEAR(std::sqrt(moments_of(rows).variance), 3, 0.18 * 3);
    EXPECT_NEAR(std::sqrt(moments_of(columns).variance), 5, 0.18 * 5);
}

// Nakagawa-type doubling: 7 K warmer, twice the current.
TEST(FixedPattern, DarkCurrentDoublesWithTemperature) {
    CameraModel c = camera_64();
    c.dark_current_e_s = 100, c.dark_reference_c = 20, c.dark_doubling_k = 7, c.temperature_c = 34;
    EXPECT_NEAR(c.dark_current_now_e_s(), 400, 1e-9);
    c.temperature_c = 13;
    EXPECT_NEAR(c.dark_current_now_e_s(), 50, 1e-9);
    Bench bench(c);
    EXPECT_NEAR(static_cast<double>(bench.expose({.exposure_s = 2}).row(3)[3]), 100, 1e-4);
}

TEST(FixedPattern, DefectsHaveTheirShares) {
    CameraModel c = camera_256();
    c.dark_current_e_s = 10;
    c.defects.hot_fraction = 0.02, c.defects.hot_e_s = 1000, c.defects.dead_fraction = 0.01;
    c.defects.dead_columns = {17}, c.defects.hot_columns = {200};
    c.defects.telegraph_fraction = 0.03, c.defects.telegraph_e = 5;
    const FixedPattern p = draw_fixed_pattern(c, {});
    double hot = 0, dead = 0, hot_sum = 0;
    for (int y = 0; y < 256; ++y)
        for (std::size_t x = 0; x < 256; ++x) {
            if (x == 17) {
                ASSERT_EQ(p.gain.row(y)[x], 0);
                continue;
            }
            if (x == 200) {
                ASSERT_TRUE(p.dark_e_s.row(y)[x] > 10.0f || p.gain.row(y)[x] == 0) << y;
                continue;
            }
            dead += p.gain.row(y)[x] == 0;
            if (p.dark_e_s.row(y)[x] > 10.001f)
                hot += 1, hot_sum += static_cast<double>(p.dark_e_s.row(y)[x]) - 10;
        }
    const double n = 254 * 256;
    EXPECT_NEAR(dead / n, 0.01, 4 * std::sqrt(0.01 / n));
    EXPECT_NEAR(hot / n, 0.02, 4 * std::sqrt(0.02 / n));
    EXPECT_NEAR(hot_sum / hot, 1000, 4 * 1000 / std::sqrt(hot));
    EXPECT_NEAR(static_cast<double>(p.telegraph.size()) / 65536, 0.03, 4 * std::sqrt(0.03 / 65536));
}

TEST(FixedPattern, AWindowShowsTheSensorsOwnPixels) {
    CameraModel c = camera_256();
    c.prnu_fraction = 0.02, c.black_rows = 2, c.black_columns = 3;
    const FixedPattern whole = draw_fixed_pattern(c, {});
    c.window_px = {101, 50, 20, 10};
    const FixedPattern part = draw_fixed_pattern(c, {});
    for (int y = 0; y < 12; ++y)
        for (std::size_t x = 0; x < 23; ++x) {
            const int full_y = y < 2 ? y : y + 50;
            const std::size_t full_x = x < 3 ? x : x + 101;
            ASSERT_EQ(part.gain.row(y)[x], whole.gain.row(full_y)[full_x]) << x << ' ' << y;
        }
}

TEST(FixedPattern, ALineCamerasLinesAreAlike) {
    CameraModel c = camera_64();
    c.prnu_fraction = 0.02, c.shutter.kind = ShutterKind::kLineScan;
    const FixedPattern p = draw_fixed_pattern(c, {});
    EXPECT_TRUE(std::equal(p.gain.row(0).begin(), p.gain.row(0).end(), p.gain.row(40).begin()));
    EXPECT_NE(p.gain.row(0)[0], p.gain.row(0)[1]);
}

TEST(FixedPattern, PicturesReplaceTheMeansAndMustFit) {
    CameraModel c = camera_64();
    c.dark_current_e_s = 10;
    DetectorPictures pictures;
    pictures.prnu = PixelMap(64, 64), pictures.dark_e_s = PixelMap(64, 64);
    for (float& v : pictures.prnu.all()) v = 1;
    for (float& v : pictures.dark_e_s.all()) v = 30;
    pictures.prnu.row(3)[4] = 0.5f;
    const FixedPattern p = draw_fixed_pattern(c, pictures);
    EXPECT_EQ(p.gain.row(3)[4], 0.5f);
    EXPECT_EQ(p.gain.row(4)[3], 1.0f);
    EXPECT_EQ(p.dark_e_s.row(9)[9], 30.0f);
    pictures.prnu = PixelMap(10, 12);
    try {
        draw_fixed_pattern(c, pictures);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(),
                    testing::HasSubstr("fixed_pattern.prnu_map: a picture of 10 x 12; accepted: "
                                       "the sensor's 64 x 64"));
    }
}

// A map and a list that were made at 20 C are of a warmer sensor at 27 C: 2^(7/7) times as much.
TEST(FixedPattern, AMapOfTheDarkCurrentFollowsTheTemperature) {
    CameraModel c = camera_64();
    c.dark_current_e_s = 10, c.dark_doubling_k = 7, c.temperature_c = 27;
    c.fixed_pattern.has_dark_map_c = true, c.fixed_pattern.dark_map_c = 20;
    DetectorPictures pictures;
    pictures.dark_e_s = PixelMap(64, 64);
    for (float& v : pictures.dark_e_s.all()) v = 30;
    pictures.defects = {{DefectKind::kHot, 5, 6, 400}};
    const FixedPattern p = draw_fixed_pattern(c, pictures);
    EXPECT_FLOAT_EQ(p.dark_e_s.row(9)[9], 60.0f);
    EXPECT_FLOAT_EQ(p.dark_e_s.row(6)[5], 800.0f);
}

TEST(FixedPattern, ListedPixelsHaveTheirDefects) {
    CameraModel c = camera_64();
    c.window_px = {10, 20, 40, 30};
    DetectorPictures pictures;
    pictures.defects = {{DefectKind::kHot, 12, 23, 350},
                        {DefectKind::kDead, 13, 23, 0},
                        {DefectKind::kBlinking, 12, 23, 18},
                        {DefectKind::kHot, 5, 5, 99}};  // outside the window
    const FixedPattern p = draw_fixed_pattern(c, pictures);
    EXPECT_EQ(p.dark_e_s.row(3)[2], 350.0f);
    EXPECT_EQ(p.dark_e_s.row(3)[4], static_cast<float>(c.dark_current_now_e_s()));
    EXPECT_EQ(p.gain.row(3)[3], 0.0f);
    EXPECT_EQ(p.gain.row(3)[2], 1.0f);
    ASSERT_EQ(p.telegraph.size(), 1u);
    EXPECT_EQ(p.telegraph[0].x, 2);
    EXPECT_EQ(p.telegraph[0].y, 3);
    EXPECT_EQ(p.telegraph[0].height_e, 18.0f);
    pictures.defects = {{DefectKind::kDead, 64, 0, 0}};
    try {
        draw_fixed_pattern(c, pictures);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "defects.list: pixel (64, 0); accepted: on the sensor of 64 x 64");
    }
}

}  // namespace
}  // namespace hilcam
