// Numbers of light alone, against the whole chain where that adds nothing else, and against the places of pixels.

#include "sensor/ideal_sensor.h"

#include <gtest/gtest.h>

#include "tests/support/cameras.h"

namespace hilcam {
namespace {

CameraModel mosaic_camera() {
    CameraModel c = camera_64();
    c.color_filter = {
        "RG GB", {{"R", Curve::constant(0.8)}, {"G", Curve::constant(0.5)}, {"B", Curve::constant(0.2)}}};
    return c;
}

// Charge rates of the camera's channels in its radiance images.
RadianceImage dark_image(const CameraModel& c, const SensorSampling& sampling) {
    const ImageGeometry g = geometry_of(c, sampling.guard_px, sampling.oversampling);
    return {g.padded_width(), g.padded_height(), channel_responses(c, SpectralGrid{{0.5, 0.6}})};
}
RadianceImage even_image(const CameraModel& c, const SensorSampling& sampling, float rate_e_s) {
    RadianceImage image = dark_image(c, sampling);
    for (int channel = 0; channel < image.planes(); ++channel)
        for (float& value : image.plane(channel)) value = static_cast<float>(channel + 1) * rate_e_s;
    return image;
}

// The lens darkens and blurs nothing in the middle of an even picture.
TEST(IdealSensor, InTheMiddleOfAnEvenPictureItsNumbersAreTheChains) {
    for (const bool mosaic : {false, true})
        for (const int oversampling : {1, 3}) {
            CameraModel c = mosaic ? mosaic_camera() : camera_64();
            c.offset_dn = 40, c.gain_dn_e = 0.5;
            const SensorSampling sampling{8, 1, oversampling};
            Bench bench(c, sampling);
            const RadianceImage light = even_image(c, sampling, 1e5f);
            const Exposure exposure{.exposure_s = 0.01, .gain_db = 6};
            bench.chain.expose(light, {}, exposure, bench.electrons);
            const DnImage numbers = IdealSensor(c, sampling).take(light, exposure, {});
            for (const auto& [x, y] : {std::array{31, 31}, {32, 31}, {31, 32}, {32, 32}}) {
                const double e = at(bench.electrons, x, y);
                EXPECT_GT(e, 900);
                // Half a number of rounding, and the lens' fall to a pixel beside the axis.
                EXPECT_NEAR(numbers.row(y)[static_cast<std::size_t>(x)], 40 + 0.5 * std::pow(10, 0.3) * e,
                            0.6)
                    << mosaic << oversampling << ' ' << x << ' ' << y;
            }
        }
}

TEST(IdealSensor, BinsAsTheCameraDoes) {
    CameraModel c = camera_64();
    c.offset_dn = 40, c.bits = 16;
    const SensorSampling sampling{8, 1, 1};
    const RadianceImage light = even_image(c, sampling, 1e5f);
    const auto number = [&](BinningKind kind) {
        c.binning = kind;
        return IdealSensor(c, sampling).take(light, {.exposure_s = 0.01}, {2, 3}).row(10)[10];
    };
    EXPECT_EQ(number(BinningKind::kCharge), 40 + 6 * 1000);
    EXPECT_EQ(number(BinningKind::kSum), 6 * (40 + 1000));
    EXPECT_EQ(number(BinningKind::kMean), 40 + 1000);
}

TEST(IdealSensor, SaturatesAndCompandsAsTheCameraDoes) {
    CameraModel c = camera_64();
    const SensorSampling sampling{8, 1, 1};
    const auto number = [&](float rate_e_s) {
        return IdealSensor(c, sampling)
            .take(even_image(c, sampling, rate_e_s), {.exposure_s = 1}, {})
            .row(5)[5];
    };
    EXPECT_EQ(number(1e9f), 4095);
    c.full_well_e = 3000;
    EXPECT_EQ(number(1e9f), 3000);
    EXPECT_EQ(number(1000), 1000);
    c.converter.companding = Companding::kSquareRoot;
    EXPECT_EQ(number(1000), std::lround(255 * std::sqrt(1000 / 4095.0)));
}

// One pixel of the image is lit; black pixels see nothing of the border beside the window.
TEST(IdealSensor, APixelIsWhereTheRasterSays) {
    CameraModel c = camera_64();
    c.black_columns = 6, c.black_rows = 3;
    for (const int oversampling : {1, 2})
        for (const FrameLayout& layout : {FrameLayout{}, FrameLayout{2, 3}, FrameLayout{1, 1, true, true},
                                          FrameLayout{4, 2, true, false}}) {
            const SensorSampling sampling{8, 1, oversampling};
            RadianceImage light = dark_image(c, sampling);
            const int guard = 8 * oversampling, x = 20 * oversampling, y = 33 * oversampling;
            light.row(y + guard)[static_cast<std::size_t>(x + guard)] = 1000;
            light.row(guard + y)[static_cast<std::size_t>(guard - 1)] = 1e6f;
            light.row(guard - 1)[static_cast<std::size_t>(guard + x)] = 1e6f;
            const DnImage numbers = IdealSensor(c, sampling).take(light, {.exposure_s = 1}, layout);
            const FrameRaster raster = raster_of(c, oversampling, layout);
            ASSERT_EQ(numbers.width(), raster.width_px);
            ASSERT_EQ(numbers.height(), raster.height_px);
            const Vec2d place = raster.frame_px({x + 0.5, y + 0.5});
            for (int j = 0; j < numbers.height(); ++j)
                for (int i = 0; i < numbers.width(); ++i)
                    ASSERT_EQ(numbers.row(j)[static_cast<std::size_t>(i)],
                              i == static_cast<int>(place.x) && j == static_cast<int>(place.y)
                                  ? 1000 / (oversampling * oversampling)
                                  : 0)
                        << i << ' ' << j;
        }
}

}  // namespace
}  // namespace hilcam
