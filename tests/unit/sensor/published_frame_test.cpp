// Where a published frame's pixels lie, and how many electrons a point makes: against what the sensor does.

#include "sensor/published_frame.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/units.h"
#include "sensor/point_electrons.h"
#include "tests/support/cameras.h"

namespace hilcam {
namespace {

// Of a dark frame with one point in it [px of the frame].
Vec2d centroid_of(const DnImage& frame) {
    double sum = 0;
    Vec2d at{};
    for (int y = 0; y < frame.height(); ++y)
        for (int x = 0; x < frame.width(); ++x) {
            const double dn = frame.row(y)[static_cast<std::size_t>(x)];
            sum += dn, at.x += dn * (x + 0.5), at.y += dn * (y + 0.5);
        }
    return {at.x / sum, at.y / sum};
}

// A point of 2.5 px and 4e5 electrons, of which shot noise moves the centroid by 2.5 / sqrt(4e5) = 0.004 px;
// black pixels, binned or not, see nothing of it. Five sigma.
TEST(PublishedFrame, APointIsWhereTheRasterSays) {
    CameraModel c = gaussian_camera(2.5);
    c.black_columns = 6, c.black_rows = 3;
    c.bits = 16, c.gain_dn_e = 0.1;
    const auto [array_width, array_height] = array_size(c);
    for (const auto& [binning_x, binning_y] : {std::array{1, 1}, std::array{2, 2}, std::array{4, 3}}) {
        Bench bench(c);
        const Exposure exposure{.exposure_s = 1, .binning_x = binning_x, .binning_y = binning_y};
        const double per_irradiance = static_cast<double>(electrons_per_s_per_irradiance(c, bench.grid)[0]);
        const PointSource point = point_at(30.3, 33.8, 4e5 / per_irradiance);
        bench.expose(exposure, std::span(&point, 1));
        const auto [width, height] = frame_size(c, binning_x, binning_y);
        DnImage frame(width, height);
        bench.chain.digitise(bench.electrons, exposure, {7, 1}, frame);
        const Vec2d seen = centroid_of(frame);
        const FrameRaster raster = raster_of(c, 1, {binning_x, binning_y});
        EXPECT_EQ(raster.width_px, array_width / binning_x);
        EXPECT_EQ(raster.height_px, array_height / binning_y);
        const Vec2d told = raster.frame_px({30.3, 33.8});
        EXPECT_NEAR(told.x, seen.x, 0.02) << binning_x;
        EXPECT_NEAR(told.y, seen.y, 0.02) << binning_y;
        // Mirrored: the frame read backwards.
        const Vec2d mirrored = raster_of(c, 1, {binning_x, binning_y, true, true}).frame_px({30.3, 33.8});
        EXPECT_NEAR(mirrored.x, width - told.x, 1e-12);
        EXPECT_NEAR(mirrored.y, height - told.y, 1e-12);
    }
}

TEST(PublishedFrame, AnOversampledImageHasTheSamePlaces) {
    CameraModel c = camera_64();
    c.black_columns = 6;
    const FrameLayout layout{2, 1, true, false};
    const Vec2d once = raster_of(c, 1, layout).frame_px({10, 20});
    const Vec2d thrice = raster_of(c, 3, layout).frame_px({30, 60});
    EXPECT_NEAR(once.x, thrice.x, 1e-12);
    EXPECT_NEAR(once.y, thrice.y, 1e-12);
    const FrameRaster raster = raster_of(c, 3, layout);
    EXPECT_NEAR(raster.image_px(raster.frame_px({5, 7})).x, 5, 1e-12);
}

// Of 0.05 / 5.5e-6 px, which two columns to one halve and a mirror turns round; the boresight meets the
// window's middle, behind six black columns.
TEST(PublishedFrame, IntrinsicsAreThoseOfTheFrame) {
    CameraModel c = camera_64();
    c.black_columns = 6;
    const FrameIntrinsics plain = intrinsics_of(geometry_of(c, 8), raster_of(c, 1, {}));
    EXPECT_NEAR(plain.focal_length_px.x, 0.05 / 5.5e-6, 1e-9);
    EXPECT_NEAR(plain.principal_point_px.x, 38, 1e-12);
    EXPECT_NEAR(plain.principal_point_px.y, 32, 1e-12);
    const FrameIntrinsics mirrored =
        intrinsics_of(geometry_of(c, 8, 2), raster_of(c, 2, {2, 1, true, false}));
    EXPECT_NEAR(mirrored.focal_length_px.x, -0.5 * 0.05 / 5.5e-6, 1e-9);
    EXPECT_NEAR(mirrored.principal_point_px.x, 35 - 19, 1e-12);
}

// E A T QE dlambda lambda / (h c) t, the middle wavelength standing for the bin as lambda is linear.
TEST(PointElectrons, AreThoseOfTheClosedFormAndOfTheDetector) {
    CameraModel c = gaussian_camera(0.8);
    Bench bench(c);
    const double d = 0.05 / 4, area = kPi / 4 * d * d;
    const double expected = 1e-9 * area * 0.9 * 0.5 * 0.1 * 0.55e-6 / (6.62607015e-34 * 299792458.0) * 2;
    const PointSource point = point_at(32, 32, 1e-9);
    const PointElectrons electrons(c, bench.grid);
    EXPECT_NEAR(electrons.of(point.irradiance_w_m2_um, {32, 32}, 2) / expected, 1, 1e-6);
    EXPECT_NEAR(sum(bench.expose({.exposure_s = 2}, std::span(&point, 1))) / expected, 1, 1e-4);
}

// A red, two greens and a blue: their mean.
TEST(PointElectrons, UnderAMosaicAreTheMeanOfItsFilters) {
    CameraModel c = gaussian_camera(0.8);
    const Spectrum light = point_at(0, 0, 1e-9).irradiance_w_m2_um;
    const SpectralGrid grid({0.5, 0.6});
    const double all = PointElectrons(c, grid).of(light, {32, 32}, 1);
    c.color_filter.pattern = "RG GB";
    c.color_filter.filters = {
        {"R", Curve::constant(0.2)}, {"G", Curve::constant(0.4)}, {"B", Curve::constant(0.8)}};
    EXPECT_NEAR(PointElectrons(c, grid).of(light, {32, 32}, 1) / all, (0.2 + 2 * 0.4 + 0.8) / 4, 1e-6);
}

}  // namespace
}  // namespace hilcam
