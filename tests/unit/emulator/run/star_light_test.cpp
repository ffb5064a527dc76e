// The electrons that the brightest stars leave in a picture, against their V and B-V by hand.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numeric>

#include "emulator/run/still_camera.h"
#include "emulator/scenario/scene_loader.h"
#include "io/files/catalogue_file.h"
#include "render/vocabulary/units.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

// A telescope that takes every photon from 0.45 to 0.75 um, so that a star's colour shows.
constexpr double kFrom_um = 0.45, kTo_um = 0.75, kExposure_s = 1e-5, kAperture_m = 0.16;

// Photons of a black body by B-V (Ballesteros 2012, eq. 14) that has 3.63e-8 W m^-2 um^-1 at 0.55 um for V =
// 0 (Bessell et al. 1998); midpoints of 0.1 nm.
double electrons_by_hand(double magnitude_v, double color_b_v) {
    const double kelvin = 4600 * (1 / (0.92 * color_b_v + 1.7) + 1 / (0.92 * color_b_v + 0.62));
    // hc / k and hc: CODATA 2018.
    const auto planck = [kelvin](double um) {
        return std::pow(um, -5) / std::expm1(14387.76877 / (um * kelvin));
    };
    constexpr double kHc_j_um = 1.986445857e-19;
    double sum = 0;
    for (double um = kFrom_um + 0.5e-4; um < kTo_um; um += 1e-4)
        sum += planck(um) / planck(0.55) * um / kHc_j_um * 1e-4;
    const double area_m2 = kPi / 4 * kAperture_m * kAperture_m;
    return 3.63e-8 * std::pow(10, -0.4 * magnitude_v) * sum * area_m2 * kExposure_s;
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
        write("one.csv", "ra_deg,dec_deg,v_mag,b_v\n" + std::to_string(ra / kDegree_rad) + "," +
                             std::to_string(dec / kDegree_rad) + "," + std::to_string(star.magnitude_v) +
                             "," + std::to_string(star.color_b_v) + "\n");
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
        EXPECT_NEAR(electrons / electrons_by_hand(star.magnitude_v, star.color_b_v), 1, 0.01)
            << "HIP " << star.hip << ", V " << star.magnitude_v << ", B-V " << star.color_b_v;
    }
}

}  // namespace
}  // namespace hilcam
