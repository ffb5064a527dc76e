#include "emulator/check/camera_sheet.h"

#include <gtest/gtest.h>

#include <cmath>

#include "emulator/check/check_command.h"
#include "emulator/check/expected_signal.h"
#include "io/config/config_yaml.h"
#include "render/sky/star_spectra.h"
#include "render/vocabulary/units.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

const std::string kCameras = HILCAM_SOURCE_DIR "/configs/cameras/";

CameraModel camera(const std::string& name, const std::vector<std::string>& overrides = {}) {
    CameraModel c;
    read_config(kCameras + name + ".yaml", section_of(c), overrides);
    return c;
}

// Integral over the camera's band, 0.40 to 0.95 um, of f(wavelength [um]).
template <class F>
double over_band(const F& f) {
    constexpr int kSteps = 5500;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) sum += f(0.40 + 0.55 * (i + 0.5) / kSteps) * 0.55 / kSteps;
    return sum;
}
// Electrons per joule at the aperture.
double electrons_per_j(const CameraModel& c, double um) {
    return c.transmission.at(um) * c.quantum_efficiency.at(um) / photon_energy_j(um);
}

TEST(CameraSheet, GeometryOfTheInspectorIsItsTrigonometry) {
    const CameraSheet s = camera_sheet(camera("inspector_1k"));
    const double half = 512 * 5.5e-6 / 9e-3;
    EXPECT_NEAR(s.field_x_rad, 2 * std::atan(half), 1e-12);
    EXPECT_NEAR(s.field_y_rad, 2 * std::atan(half), 1e-12);
    EXPECT_NEAR(s.field_diagonal_rad, 2 * std::atan(half * std::sqrt(2)), 1e-12);
    EXPECT_NEAR(s.ifov_rad, 5.5e-6 / 9e-3, 1e-15);
    EXPECT_EQ(s.frame_px[0], 1024);
    EXPECT_EQ(s.frame_bytes, 2.0 * 1024 * 1024);
}

// The midpoint rule over 20,000 steps of Planck's law, in another program: 2.3694e6 electrons of a black body of
// 300 K and 19.22 mK. Eight bins: half a percent.
TEST(CameraSheet, ACooledCamerasBlackBodyIsPlancks) {
    const CameraSheet s = camera_sheet(camera("cooled_midwave"));
    EXPECT_NEAR(s.black_body_e / 2369401, 1, 0.005);
    EXPECT_NEAR(s.netd_k * 1e3, 19.216, 0.1);
    EXPECT_NE(to_text(s).find("NETD 19.2 mK"), std::string::npos);
    EXPECT_EQ(camera_sheet(camera("inspector_1k")).netd_k, 0);
}

TEST(CameraSheet, LightOfTheInspectorIsTheIntegralOverItsCurves) {
    const CameraModel c = camera("inspector_1k");
    const CameraSheet s = camera_sheet(c);
    const double aperture_m2 = kPi / 4 * (9e-3 / 8) * (9e-3 / 8), pixel_sr = s.ifov_rad * s.ifov_rad;
    const double response =
        aperture_m2 * pixel_sr * over_band([&](double um) { return electrons_per_j(c, um); });
    // Eight bins, the curves averaged in each before they are multiplied: half a percent.
    EXPECT_NEAR(s.response_e_s / response, 1, 0.005);
    EXPECT_NEAR(s.saturation_w_m2_sr_um / ((13500 - 125 * 0.15e-3) / (response * 0.15e-3)), 1, 0.005);
    // A star of B-V = 0, V = 0, by its spectrum in bins of 5 nm.
    double star = 0;
    for (int i = 0; i < 110; ++i) {
        const double from_um = 0.40 + 0.005 * i, middle_um = from_um + 0.0025;
        const SpectralGrid grid({from_um, from_um + 0.005});
        star += 0.15e-3 * aperture_m2 * 0.005 * electrons_per_j(c, middle_um) *
                static_cast<double>(StarSpectra(grid).irradiance_w_m2_um(0, {})[0]);
    }
    EXPECT_NEAR(s.stars[0].total_e / star, 1, 0.015);
    EXPECT_NEAR(s.stars[1].total_e / s.stars[0].total_e, 0.01, 1e-6);
}

TEST(CameraSheet, SharpnessOfTheInspectorIsThatOfAnAiryDisk) {
    const CameraSheet s = camera_sheet(camera("inspector_1k"));
    EXPECT_NEAR(s.airy_radius_px, 1.22 * s.mean_um * 8 / 5.5, 1e-9);
    // At the mean wavelength: Goodman's formula; the band's spread changes it by a percent.
    const double x = 0.5 / 5.5 * s.mean_um * 8;
    EXPECT_NEAR(s.mtf_optics_x, 2 / kPi * (std::acos(x) - x * std::sqrt(1 - x * x)), 0.01);
    EXPECT_NEAR(s.mtf_pixel_x, 2 / kPi, 1e-6);
    EXPECT_NEAR(s.mtf_system_x, s.mtf_optics_x * s.mtf_pixel_x, 1e-4);
    // The Airy pattern over a square of n pixels at the mean wavelength.
    const auto share = [&](double side_px) {
        constexpr int kSteps = 300;
        const double step_px = side_px / kSteps, per_px = kPi * 5.5 / (s.mean_um * 8);
        double sum = 0;
        for (int i = 0; i < kSteps; ++i)
            for (int k = 0; k < kSteps; ++k) {
                const double v =
                    per_px * std::hypot((i + 0.5) * step_px - side_px / 2, (k + 0.5) * step_px - side_px / 2);
                const double airy = 2 * std::cyl_bessel_j(1, v) / v;
                sum += airy * airy * step_px * step_px * per_px * per_px / (4 * kPi);
            }
        return sum;
    };
    EXPECT_NEAR(s.peak_share, share(1), 0.01);
    EXPECT_NEAR(s.core_share, share(3), 0.01);
}

TEST(CameraSheet, NoiseOfTheInspectorIsItsSumOfSquares) {
    const CameraSheet s = camera_sheet(camera("inspector_1k"));
    EXPECT_NEAR(s.well_dn, 64 + 0.29 * 13500, 1e-9);
    EXPECT_NEAR(s.converter_e, (4095 - 64) / 0.29, 1e-9);
    EXPECT_EQ(s.full_scale_e, 13500);
    EXPECT_NEAR(s.shot_half_well_e, 82.158, 1e-3);
    EXPECT_NEAR(s.dark_shot_e, std::sqrt(125 * 0.15e-3), 1e-12);
    EXPECT_NEAR(s.quantisation_e, 1 / (std::sqrt(12.0) * 0.29), 1e-12);
    const double dark_e = std::sqrt(125 * 0.15e-3 + 169 + 1 / (12 * 0.29 * 0.29));
    EXPECT_NEAR(s.dark_total_e, dark_e, 1e-12);
    EXPECT_NEAR(s.dynamic_range, 13500 / dark_e, 1e-9);
    // The Moon: 0.12 of what a white surface gives.
    const double moon_e = s.scenes[1].signal_e;
    EXPECT_NEAR(moon_e, 0.12 * s.scenes[0].signal_e, 1e-9);
    EXPECT_NEAR(s.scenes[1].snr, moon_e / std::sqrt(moon_e + dark_e * dark_e), 1e-9);
    // White saturates.
    EXPECT_GT(s.scenes[0].signal_e, 13500);
    EXPECT_NEAR(s.scenes[0].snr, 13500 / std::sqrt(13500 + dark_e * dark_e), 1e-9);
    // The faintest star has an SNR of 5 in its nine pixels.
    const double n = s.stars[0].total_e * s.core_share * std::pow(10, -0.4 * s.faintest_magnitude);
    EXPECT_NEAR(n / std::sqrt(n + 9 * dark_e * dark_e), 5, 1e-6);
}

// By hand: a full well is read as 13500 (1 - 0.1) = 12150 e-; half of one as 6750 (1 - 0.05) = 6412.5 e-.
TEST(CameraSheet, AFullWellIsTheNumberThatTheAmplifierMakesOfIt) {
    const CameraModel bent = camera("inspector_1k", {"nonlinearity=[-0.1]"});
    const CameraSheet s = camera_sheet(bent);
    EXPECT_NEAR(s.well_dn, 64 + 0.29 * 12150, 1e-9);
    EXPECT_EQ(s.full_scale_e, 13500);
    EXPECT_NEAR(read_out(s, 6750 - 125 * 0.15e-3).dn, 64 + 0.29 * 6412.5, 1e-9);
    // The converter ends where that is read: at half of the well.
    const double half = camera_sheet(camera("inspector_1k", {"nonlinearity=[-0.1]",
                                                             "gain_dn_e=" + std::to_string(4031 / 6412.5)}))
                            .converter_e;
    EXPECT_NEAR(half, 6750, 0.01);
    // Numbers that are companded after that are not these.
    EXPECT_EQ(to_text(s).find("companding"), std::string::npos);
    CameraModel companded = bent;
    companded.converter.companding = Companding::kSquareRoot;
    EXPECT_NE(to_text(camera_sheet(companded)).find("before companding"), std::string::npos);
}

TEST(CameraSheet, GainAndTemperatureCount) {
    const CameraSheet s =
        camera_sheet(camera("inspector_1k", {"gain_db=6.0205999", "temperature_c=39", "exposure_ms=100"}));
    EXPECT_NEAR(s.gain_dn_e, 0.58, 1e-7);
    EXPECT_NEAR(s.dark_e_s, 500, 1e-9);  // twice every 7 K
    EXPECT_NEAR(s.dark_shot_e, std::sqrt(50.0), 1e-9);
    EXPECT_NEAR(s.full_scale_e, 4031 / 0.58, 1e-2);  // the converter ends first
    EXPECT_NE(to_text(s).find("the converter saturates first"), std::string::npos);
}

TEST(CameraSheet, ALineScannerIsItsLines) {
    const CameraSheet s = camera_sheet(camera("pleiades_pan"));
    EXPECT_NEAR(s.exposure_s, 13 * 101.92e-6, 1e-12);
    EXPECT_EQ(s.field_y_rad, s.ifov_rad);
    const std::string text = to_text(s);
    EXPECT_NE(text.find("line scan, 9811.6 lines/s, 13 stages, 4 clock phases"), std::string::npos) << text;
}

TEST(CameraSheet, BinsThatLeaveOutABandAreTold) {
    const CameraModel c = camera("inspector_1k");
    EXPECT_NEAR(share_in_bins(c, SpectralGrid({0.40, 0.95})), 1, 1e-3);
    const double blue = share_in_bins(c, SpectralGrid({0.40, 0.55})),
                 red = share_in_bins(c, SpectralGrid({0.55, 1.2}));
    EXPECT_NEAR(blue + red, 1, 0.005);
    EXPECT_GT(blue, 0.2);
    EXPECT_LT(blue, 0.5);
}

using CheckTest = FilesTest;

TEST_F(CheckTest, ACameraFileIsToldFromAScenario) {
    EXPECT_TRUE(is_camera_file(kCameras + "inspector_1k.yaml"));
    EXPECT_FALSE(is_camera_file(HILCAM_SOURCE_DIR "/configs/scenarios/small.yaml"));
    EXPECT_FALSE(is_camera_file(folder_ / "nothing.yaml"));
    EXPECT_FALSE(is_camera_file(write("broken.yaml", "pitch_um: [1")));
    EXPECT_EQ(check_camera(kCameras + "inspector_1k.yaml", {}).text.rfind("camera inspector-1k\n", 0), 0u);
    const std::string error = error_of([&] { check_camera(write("short.yaml", "pitch_um: 5\n"), {}); });
    EXPECT_NE(error.find("short.yaml"), std::string::npos) << error;
}

TEST_F(CheckTest, EveryShippedCameraHasASheetOfFiniteFigures) {
    for (const auto& entry : std::filesystem::directory_iterator(kCameras)) {
        const std::string text = check_camera(entry.path(), {}).text;
        EXPECT_EQ(text.find("nan"), std::string::npos) << text;
        EXPECT_EQ(text.find("inf,"), std::string::npos) << text;
    }
}

}  // namespace
}  // namespace hilcam
