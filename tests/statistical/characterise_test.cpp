// A camera is measured end to end from its own frames, and what it was made with comes back.

#include "emulator/characterise/characterise.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "emulator/characterise/characterise_report.h"

namespace hilcam {
namespace {

// What is asked of every camera: K and quantum efficiency to 1 %, noise and dark current to 2 %, fixed
// patterns to 5 %, MTF to 0.01. The laboratory's own uncertainties are below a third of these.
constexpr double kGain = 0.01, kNoise = 0.02, kPattern = 0.05, kMtf = 0.01;

CameraModel small_camera() {
    CameraModel c;
    c.name = "small";
    c.width_px = c.height_px = 320;
    c.pitch_m = 5e-6;
    c.focal_length_m = 0.02;
    c.f_number = 6;
    c.quantum_efficiency = {{0.4, 0.55, 0.8}, {0.3, 0.65, 0.2}, {}};
    c.full_well_e = 12000;
    c.gain_dn_e = 0.32;
    c.offset_dn = 80;
    c.read_noise_e = 7;
    c.dark_current_e_s = 60;
    c.prnu_fraction = 0.008;
    c.dsnu_e = 5;
    c.exposure_range_s = {1e-5, 5};
    return c;
}

void expect_relative(const nlohmann::json& report, const char* key, double tolerance) {
    const double configured = report[key]["configured"].get<double>();
    const double measured = report[key]["measured"].get<double>();
    const double uncertainty = report[key]["uncertainty"].get<double>();
    ASSERT_GT(configured, 0) << key;
    EXPECT_NEAR(measured / configured, 1, tolerance) << key;
    EXPECT_LT(3 * uncertainty, tolerance * configured) << key << " is not known well enough to tell";
}

nlohmann::json expect_as_made(const CameraModel& camera) {
    const Characterisation result = characterise(camera, {});
    nlohmann::json report = characterisation_json(result, {});
    for (const char* key : {"gain_dn_e", "qe_peak", "full_well_e"}) expect_relative(report, key, kGain);
    for (const char* key : {"read_noise_e", "dark_current_e_s"}) expect_relative(report, key, kNoise);
    for (const char* key : {"prnu_fraction", "dsnu_e"}) expect_relative(report, key, kPattern);
    for (const MtfCurve* curve : {&result.horizontal, &result.vertical})
        for (std::size_t i = 0; i <= curve->nyquist(); ++i) {
            EXPECT_NEAR(curve->measured[i], curve->configured[i], kMtf) << curve->frequency_cy_px[i];
            EXPECT_LT(3 * curve->uncertainty[i], kMtf);
        }
    return report;
}

TEST(Characterise, APlainCamera) {
    const nlohmann::json report = expect_as_made(small_camera());
    EXPECT_EQ(report["camera"], "small");
    EXPECT_EQ(report["gain_dn_e"]["configured"], 0.32);
    EXPECT_EQ(report["qe_peak"]["configured"], 0.65);
    // Straight: what is found is the noise of twenty means of some 10^5 pixels.
    EXPECT_LT(report["linearity_error"]["measured"].get<double>(), 1e-4);
}

// Each figure follows its own cause, and would not pass for the plain camera's.
TEST(Characterise, AnotherCameraIsSeenToBeAnother) {
    CameraModel c = small_camera();
    c.read_noise_e = 7.5;
    c.prnu_fraction = 0.009;
    c.gain_dn_e = 0.327;
    c.defocus_m = 60e-6;
    const Characterisation other = characterise(c, {});
    const nlohmann::json report = characterisation_json(other, {});
    EXPECT_GT(std::abs(report["gain_dn_e"]["measured"].get<double>() / 0.32 - 1), kGain);
    EXPECT_GT(std::abs(report["read_noise_e"]["measured"].get<double>() / 7 - 1), kNoise);
    EXPECT_GT(std::abs(report["prnu_fraction"]["measured"].get<double>() / 0.008 - 1), kPattern);
    const Characterisation plain = characterise(small_camera(), {});
    const std::size_t nyquist = plain.horizontal.nyquist();
    EXPECT_GT(plain.horizontal.configured[nyquist] - other.horizontal.measured[nyquist], kMtf);
}

// A response that bends by 3 % and a converter that bends by 2 steps of 4096; row noise, 1/f noise, defects.
TEST(Characterise, ACameraThatIsNotIdeal) {
    CameraModel c = small_camera();
    c.nonlinearity = {-0.02, -0.01};
    c.converter.inl_lsb = 2;
    c.row_noise_e = 2;
    c.flicker_noise_e = 3;
    c.fixed_pattern.column_e = 3;
    c.fixed_pattern.column_gain_fraction = 0.003;
    c.defects.hot_fraction = 1e-3, c.defects.hot_e_s = 3000;
    c.defects.dead_fraction = 3e-4;
    c.defects.telegraph_fraction = 1e-3, c.defects.telegraph_e = 60;
    const nlohmann::json report = expect_as_made(c);
    // 1.3e-3 of some 92,000 pixels, telegraph pixels besides that happened to change.
    EXPECT_GT(report["defects"].get<double>(), 90);
    EXPECT_LT(report["defects"].get<double>(), 250);
    // The standard's procedure finds the curve's own error, not that of a straight one.
    const double promised = report["linearity_error"]["configured"].get<double>();
    EXPECT_GT(promised, 1e-3);
    EXPECT_NEAR(report["linearity_error"]["measured"].get<double>() / promised, 1, 0.05);
}

// Electronics that smear along the row: noise is coloured, K must not follow.
TEST(Characterise, ACameraWithFiltersAlongTheRow) {
    CameraModel c = small_camera();
    c.filters.low_pass_cy_px = 0.35;
    c.filters.boost = 0.2;
    c.black_columns = 16, c.black_rows = 8;
    expect_as_made(c);
}

// The green pixels of a Bayer pattern, little noise for the converter's steps, glare, binning, companding.
TEST(Characterise, AColourCameraAsItIsUsed) {
    CameraModel c = small_camera();
    c.color_filter.pattern = "RG GB";
    c.color_filter.filters = {{"R", {{0.4, 0.58, 0.62, 0.8}, {0.02, 0.05, 0.9, 0.9}, {}}},
                              {"G", {{0.4, 0.5, 0.55, 0.6, 0.8}, {0.05, 0.8, 0.9, 0.1, 0.05}, {}}},
                              {"B", {{0.4, 0.5, 0.55, 0.8}, {0.9, 0.5, 0.05, 0.02}, {}}}};
    c.stray_light.veiling_glare_fraction = 0.04;
    c.read_noise_e = 1.2;
    c.gain_range_db = {0, 20};
    c.binning_x = c.binning_y = 2;
    c.converter.companding = Companding::kSquareRoot;
    const nlohmann::json report = expect_as_made(c);
    EXPECT_EQ(report["settings"]["color_filter"], "G");
    EXPECT_GT(report["settings"]["dark_gain_db"].get<double>(), 0);
    // Glare takes its share of everything but large surfaces.
    EXPECT_NEAR(report["mtf"]["horizontal"]["points"][4]["measured"].get<double>() /
                    report["mtf"]["horizontal"]["points"][4]["configured"].get<double>(),
                1, 0.005);
}

// Rows that pass the light on their way out, charge that stays behind, and noise of half a step of the
// converter without a gain that could lift it: the dark signal's does.
TEST(Characterise, AFrameTransferCcd) {
    CameraModel c = small_camera();
    c.shutter.kind = ShutterKind::kFrameTransfer;
    c.shutter.line_time_s = 4e-6;
    c.ccd.blooming = true;
    c.ccd.parallel_inefficiency = c.ccd.serial_inefficiency = 3e-5;
    c.full_well_e = 100000, c.gain_dn_e = 0.04;
    c.read_noise_e = 12.5;
    c.dsnu_e = 25;
    c.dark_current_e_s = 2000;
    c.gain_range_db = {0, 0};
    const nlohmann::json report = expect_as_made(c);
    EXPECT_EQ(report["settings"]["dark_gain_db"], 0.0);
}

// As small as a guide window: an edge of 48 pixels is enough for the MTF.
TEST(Characterise, ASmallWindow) {
    CameraModel c = small_camera();
    c.width_px = c.height_px = 64;
    const Characterisation result = characterise(c, {});
    const std::size_t nyquist = result.horizontal.nyquist();
    EXPECT_NEAR(result.horizontal.measured[nyquist], result.horizontal.configured[nyquist], kMtf);
    EXPECT_NEAR(result.gain_dn_e.value, 0.32, 4 * result.gain_dn_e.uncertainty);
}

// A line camera: one row of pixels, an exposure of its line clock alone.
TEST(Characterise, ALineCamera) {
    CameraModel c = small_camera();
    c.width_px = 3000, c.height_px = 128;
    c.shutter.kind = ShutterKind::kLineScan;
    c.shutter.line_time_s = 200e-6;
    c.shutter.tdi_stages = 8, c.shutter.tdi_phases = 4;
    c.dark_current_e_s = 900;
    const nlohmann::json report = expect_as_made(c);
    EXPECT_EQ(report["settings"]["levels_by"], "light");
}

// On one thread as on many, now as before.
TEST(Characterise, TheSameCameraGivesTheSameReport) {
    CameraModel c = small_camera();
    c.window_px = {40, 40, 160, 160};
    const auto report = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return characterisation_json(characterise(c, {}), {});
    };
    EXPECT_EQ(report(1), report(4));
}

}  // namespace
}  // namespace hilcam
