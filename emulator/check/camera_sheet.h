#pragma once
// A camera's data sheet: what follows from its file, as a camera engineer writes it down.
//
// All figures are of the middle of the field, of a detector's pixel before binning, without defects, at the
// settings of power-up, over the wavelengths that all of the camera's curves cover. With a colour filter
// array they are of the filter that a white surface saturates first.
//
// S: response, e-/s per unit of radiance (sensor/optics.h); T exposure; K DN per electron; sigma_d dark noise
// without dark current [e-]; D dark current [e-/s].
//   noise of a signal of n e-: sqrt(n + D T + sigma_d^2 + 1 / (12 K^2))     EMVA 1288 release 4.0, eq. 16 to
//   saturation: the least of full well and converter's end, in e-           18, with the ADC's step as q /
//   sqrt 12 dynamic range: saturation over the noise in the dark faintest star: the magnitude whose light in
//   3 x 3 pixels has 5 times the noise of it; n = (25 + sqrt(625 +
//                  100 B)) / 2 e-, B the variance of nine dark pixels
//   scenes: radiance a E / pi of a surface of albedo a in the Sun's irradiance E at 1 au

#include <array>
#include <string>
#include <vector>

#include "sensor/camera_model.h"

namespace hilcam {

struct CameraSheet {
    struct Scene {
        std::string name;
        double signal_e = 0;  // without saturation
        double snr = 0;       // at the lesser of signal and full scale
    };
    struct Star {
        double magnitude = 0;
        double total_e = 0;
        double peak_e = 0;  // electrons of the pixel on which it is centred
        double snr = 0;     // signal over noise of that pixel
    };

    CameraModel camera;
    double from_um = 0, to_um = 0, mean_um = 0;  // mean: of the photo-electrons of a sunlit grey surface
    std::string filter;                          // name of the array's filter
    // Geometry.
    double field_x_rad = 0, field_y_rad = 0, field_diagonal_rad = 0;
    double ifov_rad = 0;
    std::array<int, 2> frame_px{};
    double frame_bytes = 0;
    // Lens.
    double transmission = 0, t_number = 0;  // at mean_um
    double airy_radius_px = 0;              // first dark ring, 1.22 lambda N, of a clear aperture
    double mtf_optics_x = 0, mtf_optics_y = 0, mtf_pixel_x = 0, mtf_pixel_y = 0;  // at Nyquist
    double mtf_system_x = 0, mtf_system_y = 0;                                    // all that acts
    // Radiometry.
    double exposure_s = 0, gain_dn_e = 0;
    double response_e_s = 0;             // per W m^-2 sr^-1 um^-1 of a grey source
    double full_scale_e = 0;             // least of the two below
    double well_e = 0, converter_e = 0;  // saturation of each
    double well_dn = 0, max_dn = 0;      // the converter's, before companding
    double saturation_w_m2_sr_um = 0;
    std::vector<Scene> scenes;
    std::vector<Star> stars;
    double peak_share = 0, core_share = 0;  // shares of a star's electrons: in the middle pixel, in 3 x 3
    double faintest_magnitude = 0;
    // Noise [e-].
    double dark_e_s = 0;  // at the operating temperature
    double shot_half_well_e = 0, dark_shot_e = 0, quantisation_e = 0, prnu_half_well_e = 0;
    double dark_total_e = 0;  // temporal noise of a dark pixel
    double dynamic_range = 0;
};

CameraSheet camera_sheet(const CameraModel& camera);
std::string to_text(const CameraSheet& sheet);

// The share of the camera's photo-electrons from a sunlit grey surface that lies within a scenario's bins.
double share_in_bins(const CameraModel& camera, const SpectralGrid& bins);

}  // namespace hilcam
