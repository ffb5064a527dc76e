#include "sensor/camera_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "render/vocabulary/check.h"
#include "tests/support/cameras.h"

namespace hilcam {
namespace {

TEST(CameraModel, RefusesWhatCannotBeByName) {
    const std::vector<std::pair<const char*, std::function<void(CameraModel&)>>> wrong = {
        {"exposure_ms: lies outside exposure_range_ms at power-up: found 100000; accepted: a value inside "
         "[0.001, 10000], or another exposure_range_ms",
         [](CameraModel& c) { c.exposure_s = 100; }},
        {"sum_bits: has no effect without binning: sum", [](CameraModel& c) { c.sum_bits = 14; }},
        {"sum_bits: found 11; accepted: no less than bits 12",
         [](CameraModel& c) { c.sum_bits = 11, c.binning = BinningKind::kSum; }},
        {"offset_dn: 5000 leaves nothing of the ADC's 12 bits", [](CameraModel& c) { c.offset_dn = 5000; }},
        {"bits 12 do not fit into container_bits 8", [](CameraModel& c) { c.container_bits = 8; }},
        {"packing gige with 14 bits; accepted: 10 or 12",
         [](CameraModel& c) { c.bits = 14, c.packing = Packing::kGige; }},
        {"container_bits: found 12; accepted: 8 or 16", [](CameraModel& c) { c.container_bits = 12; }},
        {"either gain_dn_e or gain_e_dn; found both", [](CameraModel& c) { c.has_gain_e_dn = true; }},
        {"either gain_dn_e or gain_e_dn; found neither",
         [](CameraModel& c) { c.has_gain_dn_e = false, c.gain_dn_e = 0; }},
        {"t_number 2 is below f_number 4", [](CameraModel& c) { c.has_t_number = true, c.t_number = 2; }},
        {"t_number and transmission say the same",
         [](CameraModel& c) { c.has_t_number = c.has_transmission = true, c.t_number = 5; }},
        {"pixel_aperture_um: found 6; accepted: no more than pitch_um 5.5",
         [](CameraModel& c) {
             c.pixel_aperture_m = {6e-6, 5e-6};
         }},
        {"measured_mtf.mtf begins at [1, 0.5]",
         [](CameraModel& c) {
             c.measured_mtf.mtf = {{1}, {0.5}};
         }},
        {"measured_mtf stands in place of",
         [](CameraModel& c) {
             c.measured_mtf.mtf = {{0}, {1}}, c.defocus_m = 1e-6;
         }},
        {"field_zones: found field_fraction 0.5 after 0.5",
         [](CameraModel& c) {
             c.field_zones = {{0.5, 0, 0}, {0.5, 0, 0}};
         }},
        {"nonlinearity: found a response that falls",
         [](CameraModel& c) {
             c.nonlinearity = {-0.5, -0.5};
         }},
        {"window_px: reaches outside the sensor of 64 x 64",
         [](CameraModel& c) {
             c.window_px = {60, 0, 10, 10};
         }},
        {"window_px: found 0.5; accepted: whole pixels",
         [](CameraModel& c) {
             c.window_px = {0.5, 0, 10, 10};
         }},
        {"binning_x, binning_y: found 2 and 1",
         [](CameraModel& c) {
             c.window_px = {0, 0, 1, 1}, c.binning_x = 2;
         }},
        {"tdi_stages and tdi_mismatch_fraction need shutter.kind line_scan",
         [](CameraModel& c) { c.shutter.tdi_stages = 8; }},
        {"auto_exposure.on and sequence",
         [](CameraModel& c) {
             c.auto_exposure.on = true, c.sequence = {{1e-3, 0}};
         }},
        {"defects: column 64; accepted: whole, below width_px 64",
         [](CameraModel& c) { c.defects.dead_columns = {64}; }},
        {"distortion_x_mm, distortion_y_mm: found with projection fisheye",
         [](CameraModel& c) { c.projection = Projection::kFisheye, c.distortion_y_mm = {0.1}; }},
        {"the lens folds over", [](CameraModel& c) { c.focal_length_m = 2e-4, c.distortion = {-2}; }},
    };
    EXPECT_NO_THROW(validate(camera_64()));
    for (const auto& [message, change] : wrong) {
        CameraModel c = camera_64();
        change(c);
        try {
            validate(c);
            ADD_FAILURE() << message;
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr(message));
        }
    }
}

TEST(CameraModel, ColorFiltersPatternNamesItsFilters) {
    ColorFilterArrayConfig c{"RG GB", {{"R", Curve::constant(1)}, {"G", Curve::constant(1)}}};
    EXPECT_THROW(validate(c), InputError);
    c.filters.push_back({"B", Curve::constant(1)});
    EXPECT_NO_THROW(validate(c));
    c.pattern = "RG GBR";
    EXPECT_THROW(validate(c), InputError);
}

TEST(CameraModel, GainIsWhatTheDataSheetGivesEitherWay) {
    CameraModel c = camera_64();
    c.gain_dn_e = 0.25;
    EXPECT_NEAR(c.system_gain_dn_e(6.0206), 0.5, 1e-5);
    c.has_gain_dn_e = false, c.has_gain_e_dn = true, c.gain_e_dn = 4;
    EXPECT_NEAR(c.system_gain_dn_e(0), 0.25, 1e-12);
}

TEST(CameraModel, AWindowLooksWhereTheSensorDoes) {
    CameraModel c = camera_64();
    c.principal_point_px = {30, 35};
    const ImageGeometry whole = geometry_of(c, 0);
    EXPECT_NEAR(whole.direction_camera(30, 35).x, 0, 1e-12);
    c.window_px = {10, 20, 8, 9};
    for (const int m : {1, 2}) {
        const ImageGeometry part = geometry_of(c, 0, m);
        const Vec3d a = part.direction_camera(3.5 * m, 2.5 * m), b = whole.direction_camera(13.5, 22.5);
        EXPECT_NEAR(a.x, b.x, 1e-12);
        EXPECT_NEAR(a.y, b.y, 1e-12);
    }
}

// OpenCV's fisheye: theta_d = theta (1 + k1 theta^2), at 45 degrees.
TEST(CameraModel, AFisheyeIsOpenCvs) {
    CameraModel c = camera_64();
    c.projection = Projection::kFisheye, c.focal_length_m = 2e-4, c.distortion = {0.05};
    EXPECT_NO_THROW(validate(c));
    const ImageGeometry g = geometry_of(c, 0);
    const double theta = 0.78539816339744830962, f = 2e-4 / 5.5e-6;
    const Vec2d p = g.project_px({1, 0, 1});
    EXPECT_NEAR(p.x, 32 + f * theta * (1 + 0.05 * theta * theta), 1e-9);
    const Vec3d back = g.direction_camera(p.x, p.y);
    EXPECT_NEAR(back.x, 1, 1e-9);
}

}  // namespace
}  // namespace hilcam
