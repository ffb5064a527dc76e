// The electrons that the brightest stars leave in a picture, against their V and colours by hand.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numeric>

#include "emulator/run/still_camera.h"
#include "emulator/scenario/scene_loader.h"
#include "io/files/catalogue_file.h"
#include "render/sky/star_spectra.h"
#include "render/vocabulary/units.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

// A telescope that takes every photon from 0.45 to 0.75 um, so that a star's colour shows.
constexpr double kFrom_um = 0.45, kTo_um = 0.75, kExposure_s = 1e-5, kAperture_m = 0.16;

// Photons by the star's spectrum in bins of 2.5 nm: what the scenario's six bins, its lens and detector are to make of it.
double electrons_by_hand(const CatalogueStar& star) {
    constexpr double kHc_j_um = 1.986445857e-19;  // CODATA 2018
    double sum = 0;
    constexpr double kBin_um = 0.0025;
    for (double from_um = kFrom_um; from_um < kTo_um - 1e-9; from_um += 8 * kBin_um) {
        std::vector<double> edges;
        for (int i = 0; i <= 8; ++i) edges.push_back(from_um + kBin_um * i);
        const SpectralGrid grid(edges);
        const Spectrum light =
            StarSpectra(grid).irradiance_w_m2_um(star.magnitude_v, {star.color_b_v, star.color_v_i});
        for (int b = 0; b < grid.size(); ++b)
            sum += static_cast<double>(light[b]) * grid.center_um(b) / kHc_j_um * kBin_um;
    }
    return sum * kPi / 4 * kAperture_m * kAperture_m * kExposure_s;
}

class StarLight : public FilesTest {};

TEST_F(StarLight, FiftyBrightStarsHaveTheElectronsOfTheirMagnitudeAndColour) {
    const StarCatalogue catalogue = load_catalogue(HILCAM_SOURCE_DIR "/configs/stars/hipparcos.csv");
    std::vector<CatalogueStar> stars = catalogue.stars;
    std::sort(stars.begin(), stars.end(),
              [](const CatalogueStar& a, const CatalogueStar& b) { return a.magnitude_v < b.magnitude_v; });
    for (std::size_t i = 0; i < 50; ++i) {
        const CatalogueStar& star = stars[i];
        const double ra = star.right_ascension_rad, dec = star.declination_rad;
        // Alone: its neighbours are not to be in its sum.
        const std::string v_i = star.color_v_i ? std::to_string(*star.color_v_i) : "";
        write("one.csv", "ra_deg,dec_deg,v_mag,b_v,v_i\n" + std::to_string(ra / kDegree_rad) + "," +
                             std::to_string(dec / kDegree_rad) + "," + std::to_string(star.magnitude_v) +
                             "," + std::to_string(star.color_b_v) + "," + v_i + "\n");
        const auto file = write(
            "star.yaml",
            "time_utc: 2026-06-21T00:00:00Z\nspectrum_edges_um: [0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75]\n"
            "camera: {name: telescope, width_px: 96, height_px: 96, pitch_um: 10, focal_length_mm: 640,\n"
            "  f_number: 4, transmission: 1, quantum_efficiency: 1, full_well_e: 1e8, gain_dn_e: 0.01, bits: "
            "12,\n"
            "  exposure_ms: 0.01}\n"
            "camera_pose: {attitude: look_at, up: [0.1, 0.2, 0.9], look_at_m: [" +
                std::to_string(1e12 * std::cos(dec) * std::cos(ra)) + ", " +
                std::to_string(1e12 * std::cos(dec) * std::sin(ra)) + ", " +
                std::to_string(1e12 * std::sin(dec)) +
                "]}\nearth: {visible: false}\nmoon: {visible: false}\nstars: {catalogue: one.csv}\n");
        StillCamera camera(load_scenario(file, {}));
        camera.render({1, 1});
        const std::span<const float> light = camera.expose().all();
        const double electrons = std::accumulate(light.begin(), light.end(), 0.0);
        EXPECT_NEAR(electrons / electrons_by_hand(star), 1, 0.015)
            << "HIP " << star.hip << ", V " << star.magnitude_v << ", B-V " << star.color_b_v;
    }
}

}  // namespace
}  // namespace hilcam
