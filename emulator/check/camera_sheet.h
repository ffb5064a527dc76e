#pragma once
// A camera's data sheet: the figures that follow from its file, as a camera engineer would write them down.
//
// Figures hold for the middle of the field and a single pixel before binning, without defects, at power-up
// settings, over the wavelengths that all of the camera's curves cover. With a colour filter array they hold
// for the filter that a white surface saturates first.
//
// S: response, e-/s per unit of radiance (sensor/optics.h); T: exposure; K: DN per electron; sigma_d: dark
// noise without dark current [e-]; D: dark current [e-/s].
//
//   noise of a signal of n e-: sqrt(n + D T + sigma_d^2 + 1 / (12 K^2))
//       EMVA 1288 release 4.0, eq. 16 to 18, with the ADC's step as q / sqrt 12
//   saturation: full well or the converter's end, whichever is smaller, in e-
//   dynamic range: saturation over the noise in the dark
//   faintest star: its light in 3 x 3 pixels is 5 times the noise there;
//       n = (25 + sqrt(625 + 100 B)) / 2 e-, B the variance of nine dark pixels
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
        double snr = 0;       // for the signal, or full scale if that is smaller
    };
    struct Star {
        double magnitude = 0;
        double total_e = 0;
        double peak_e = 0;  // electrons in the pixel at the star's centre
        double snr = 0;     // signal over noise of that pixel
    };

    CameraModel camera;
    double from_um = 0, to_um = 0, mean_um = 0;  // range; mean for photo-electrons of a sunlit grey surface
    std::string filter;                          // colour filter that the figures hold for
    // Geometry.
    double field_x_rad = 0, field_y_rad = 0, field_diagonal_rad = 0;
    double ifov_rad = 0;
    std::array<int, 2> frame_px{};
    double frame_bytes = 0;
    // Lens.
    double transmission = 0, t_number = 0;  // at mean_um
    double airy_radius_px = 0;              // first dark ring of a clear aperture, 1.22 lambda N
    double mtf_optics_x = 0, mtf_optics_y = 0, mtf_pixel_x = 0, mtf_pixel_y = 0;  // at Nyquist
    double mtf_system_x = 0, mtf_system_y = 0;  // all contributions together
    // Radiometry.
    double exposure_s = 0, gain_dn_e = 0;
    double response_e_s = 0;             // per W m^-2 sr^-1 um^-1 of a grey source
    double full_scale_e = 0;             // smaller of well_e and converter_e
    double well_e = 0, converter_e = 0;  // charge at which each saturates
    double well_dn = 0, max_dn = 0;      // converter's numbers, before companding
    double saturation_w_m2_sr_um = 0;
    std::vector<Scene> scenes;
    // A black body of 300 K, and the noise-equivalent temperature difference of one pixel before it; 0: the
    // camera sees no thermal light.
    double black_body_e = 0, netd_k = 0;
    std::vector<Star> stars;
    double peak_share = 0, core_share = 0;  // shares of a star's electrons in the central pixel and in 3 x 3
    double faintest_magnitude = 0;
    // Noise [e-].
    double dark_e_s = 0;  // at the operating temperature
    double shot_half_well_e = 0, dark_shot_e = 0, quantisation_e = 0, prnu_half_well_e = 0;
    double dark_total_e = 0;  // temporal noise of a dark pixel
    double dynamic_range = 0;
};

inline constexpr double kRoomTemperature_k = 300;

CameraSheet camera_sheet(const CameraModel& camera);
// Returns the electrons of a surface's own radiance by the bins of a scenario.
double emitted_e(const CameraSheet& sheet, const SpectralGrid& grid, const Spectrum& radiance_w_m2_sr_um);
std::string to_text(const CameraSheet& sheet);

// Returns which share of the camera's photo-electrons from a sunlit grey surface has wavelengths within the
// scenario's bins.
double share_in_bins(const CameraModel& camera, const SpectralGrid& bins);

}  // namespace hilcam
