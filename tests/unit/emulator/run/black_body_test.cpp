// A black body before a cooled camera: its electrons and digital numbers, against Planck's law by hand.

#include <gtest/gtest.h>

#include <cmath>

#include "emulator/run/still_camera.h"
#include "emulator/scenario/scene_loader.h"
#include "render/vocabulary/units.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

constexpr double kBandFrom_um = 3.4, kBandTo_um = 5.0, kQe = 0.8, kTransmission = 0.85, kStop = 2.5;
constexpr double kPitch_m = 15e-6, kCooledExposure_s = 3e-3, kGain_e_dn = 440, kOffset_dn = 100;

// pi L / (4 N^2) through the pixel's area, by the midpoint rule on Planck's law.
double black_body_by_hand(double kelvin) {
    constexpr double kHc_j_um = 1.986445857e-19, kC1_w_um4_m2_sr = 1.191042972e8, kC2_um_k = 14387.76877;
    constexpr int kSteps = 4000;
    double photons = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double um = kBandFrom_um + (kBandTo_um - kBandFrom_um) * (i + 0.5) / kSteps;
        photons += kC1_w_um4_m2_sr / std::pow(um, 5) / std::expm1(kC2_um_k / (um * kelvin)) * um / kHc_j_um *
                   (kBandTo_um - kBandFrom_um) / kSteps;
    }
    return photons * kPi / (4 * kStop * kStop) * kTransmission * kQe * kPitch_m * kPitch_m *
           kCooledExposure_s;
}

class BlackBody : public FilesTest {};

// A plate of emissivity 0.9 at 250, 300 and 330 K, so far from all else that it reflects the dark.
TEST_F(BlackBody, APlatesNumbersAreThoseOfItsTemperature) {
    write("plate.obj", "v -10 -10 5\nv 10 -10 5\nv 10 10 5\nv -10 10 5\nusemtl face\nf 1 4 3 2\n");
    for (const double kelvin : {250.0, 300.0, 330.0}) {
        const auto file =
            write("plate.yaml",
                  "time_utc: 2026-06-21T00:00:00Z\norigin: {kind: free}\nsun: {direction: [0, 0, 1]}\n"
                  "radiance: emissive\nspectrum_edges_um: [3.4, 3.6, 3.8, 4.0, 4.2, 4.4, 4.6, 4.8, 5.0]\n"
                  "camera: {name: cooled, width_px: 64, height_px: 64, pitch_um: 15, focal_length_mm: 50,\n"
                  "  f_number: 2.5, transmission: 0.85, quantum_efficiency: 0.8, full_well_e: 7e6,\n"
                  "  gain_e_dn: 440, offset_dn: 100, bits: 14, exposure_ms: 3}\n"
                  "camera_pose: {position_m: [0, 0, 0]}\n"
                  "objects:\n  - name: plate\n    mesh: plate.obj\n    temperature_k: " +
                      std::to_string(kelvin) +
                      "\n    materials: {surfaces: [{name: \"*\", material: {infrared_emissivity: 0.9}}]}\n");
        StillCamera camera(load_scenario(file, {}));
        camera.render({1, 1});
        const double expected_e = 0.9 * black_body_by_hand(kelvin);
        const auto middle = [](const auto& image) {
            double sum = 0;
            for (int y = 24; y < 40; ++y)
                for (std::size_t x = 24; x < 40; ++x) sum += static_cast<double>(image.row(y)[x]);
            return sum / 256;
        };
        EXPECT_NEAR(middle(camera.expose()) / expected_e, 1, 0.003) << kelvin;
        const double dn = middle(camera.digitise({1, 1}));
        EXPECT_NEAR((dn - kOffset_dn) * kGain_e_dn / expected_e, 1, 0.005) << kelvin;
    }
}

}  // namespace
}  // namespace hilcam
