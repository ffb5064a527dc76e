#pragma once
// Sets up a camera on the bench for `hilcam characterise`: the settings that a laboratory would choose, and
// the light and exposure times that the measurements need. Everything follows from the data sheet.

#include <string>
#include <vector>

#include "emulator/characterise/camera_bench.h"
#include "sensor/measure/frame_statistics.h"

namespace hilcam {

struct LabSetup {
    CameraModel camera;                // camera with window, binning, ... as set for the measurement
    std::vector<std::string> remarks;  // changed settings, for the report
    double wavelength_um = 0.55;       // a narrow line at the greatest quantum efficiency
    SpectralGrid grid{{0.5495, 0.5505}};
    char filter = 0;          // colour plane that is measured; 0: no colour filters
    double gain_db = 0;       // gain for the measurements with light
    double dark_gain_db = 0;  // gain in the dark, raised until the noise spans the converter's steps
    double exposure_s = 0;    // at which less than half of the lamp's light saturates
    bool by_light = false;    // true: levels by dimming the light at exposure_s; false: by exposure time
    double shortest_s = 0;    // shortest exposure in the dark
    double longest_s = 0;     // longest exposure in the dark; its signal is still far below saturation
    double lamp_w_m2_um = 0;  // light that saturates kOverexposure times at exposure_s
};
inline constexpr double kOverexposure = 3;

LabSetup lab_setup(const CameraModel& camera);

// Sets the number of lines of a line camera, which is free unless map files fix it.
void require_lines(CameraModel& camera, int lines);

// Returns the pixels of the window that count: one colour filter's, without black pixels, and without the
// margin that lacks light from outside the window.
PixelSelection lab_selection(const LabSetup& setup);

// Keeps the pixels that the lens lights within 1 % of the brightest one (EMVA 1288, section 5.2, asks for 3
// %); others would not saturate together.
PixelSelection evenly_lit(const LabSetup& setup, PixelSelection selection);

// Returns the photons per second on the light-sensitive area of a mean pixel of the selection, for the lamp's
// radiance on the white plate: L dlambda A (pitch/f)^2 fill T lambda / (h c), times the lens's relative
// illumination.
double photons_per_s(const LabSetup& setup, const PixelSelection& selection);

// --- what the data sheet promises
// Returns electrons per photon at the wavelength, including the colour filter's transmission.
double configured_quantum_efficiency(const LabSetup& setup);
// Returns the converter's signal for a charge, without the black level [DN]: gain, nonlinearity, integral
// error.
double configured_signal_dn(const CameraModel& camera, double charge_e, double gain_db);
// Returns the full well or the charge at the converter's end, whichever is smaller [e-].
double configured_saturation_e(const CameraModel& camera, double gain_db);

}  // namespace hilcam
