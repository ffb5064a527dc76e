#pragma once
// How a camera is put on the bench for `hilcam characterise`: what a laboratory would set, and what light and
// exposure times its measurements need. Follows from the data sheet alone.

#include <string>
#include <vector>

#include "emulator/characterise/camera_bench.h"
#include "sensor/measure/frame_statistics.h"

namespace hilcam {

struct LabSetup {
    CameraModel camera;                // with window, binning, ... as set for the measurement
    std::vector<std::string> remarks;  // what was set, for the report
    double wavelength_um = 0.55;       // of the light: a line at the greatest quantum efficiency
    SpectralGrid grid{{0.5495, 0.5505}};
    char filter = 0;          // letter of the colour plane that is measured; 0: no filters
    double gain_db = 0;       // of the measurements with light
    double dark_gain_db = 0;  // of those in the dark: raised until noise crosses the converter's steps
    double exposure_s = 0;    // at which half the filter's light or less saturates
    bool by_light = false;    // levels by dimming the light, at that exposure; else by exposure time
    double shortest_s = 0;    // in the dark
    double longest_s = 0;     // in the dark, signal still small against saturation
    double lamp_w_m2_um = 0;  // saturates kOverexposure times at exposure_s
};
inline constexpr double kOverexposure = 3;

LabSetup lab_setup(const CameraModel& camera);

// A line camera takes as many lines as one wants; map files fix its size.
void require_lines(CameraModel& camera, int lines);

// What the pixels of the window count: without black ones and without a margin where what lies outside the
// window is missing; of one colour filter.
PixelSelection lab_selection(const LabSetup& setup);

// Those of them that the lens lights within one percent of the brightest (section 5.2 asks for 3 %): others
// would not saturate together.
PixelSelection evenly_lit(const LabSetup& setup, PixelSelection selection);

// Photons a second on the light-sensitive area of a mean pixel of the selection, from the lamp's radiance on
// the white plate: L dlambda A (pitch/f)^2 fill T lambda / (h c), with the lens's relative illumination.
double photons_per_s(const LabSetup& setup, const PixelSelection& selection);

// --- what the data sheet promises
// Electrons per photon at the wavelength, the colour filter's transmission included.
double configured_quantum_efficiency(const LabSetup& setup);
// What the converter shows of a charge, without black level [DN]: gain, nonlinearity, integral error.
double configured_signal_dn(const CameraModel& camera, double charge_e, double gain_db);
// The lesser of the full well and the charge at the converter's end [e-].
double configured_saturation_e(const CameraModel& camera, double gain_db);

}  // namespace hilcam
