#pragma once
// A camera in the terms of its data sheet (EMVA 1288 vocabulary). One YAML file is one camera.

#include <cstdint>
#include <string>

#include "render/config_field.h"
#include "render/image_geometry.h"

namespace hilcam {

struct CameraModel {
    std::string name;
    std::string source;  // where the figures come from

    // Geometry.
    std::int64_t width_px = 1024;
    std::int64_t height_px = 1024;
    double pitch_m = 5.5e-6;
    double focal_length_m = 0.016;
    std::vector<double> distortion;  // k1, k2, p1, p2, k3 as OpenCV orders them; fewer: the rest are 0

    // Optics.
    double f_number = 4;
    Curve transmission = Curve::constant(0.9);  // of all glass and filters, 0..1
    double central_obscuration_ratio = 0;       // of diameters
    double defocus_m = 0;                       // shift of the image plane from focus
    double cos_power = 4;                       // irradiance falls as cos^n of the field angle

    // Detector.
    Curve quantum_efficiency =
        Curve::constant(0.5);  // electrons per photon on the light-sensitive area, 0..1
    double fill_factor = 1;    // light-sensitive share of the pixel, a centred square
    double full_well_e = 1e4;
    double dark_current_e_s = 0;  // at the operating temperature
    double read_noise_e = 0;      // standard deviation, temporal

    // Electronics.
    double gain_dn_e = 1;  // DN per electron at 0 dB (EMVA's K)
    double offset_dn = 0;
    std::int64_t bits = 12;

    // Settings at power-up and what the camera accepts.
    double exposure_s = 1e-3;
    double gain_db = 0;
    double frame_rate_hz = 30;
    std::vector<double> exposure_range_s = {1e-6, 10};
    std::vector<double> gain_range_db = {0, 24};
    std::vector<double> frame_rate_range_hz = {0.01, 200};

    double aperture_diameter_m() const { return focal_length_m / f_number; }
};

Fields fields(CameraModel& camera);
// Refuses what contradicts itself; the message names the keys. InputError.
void validate(const CameraModel& camera);

ImageGeometry geometry_of(const CameraModel& camera, int guard_px);

}  // namespace hilcam
