#pragma once
// Electrons in closed form, of a camera whose transmission and efficiency are the same at all wavelengths.

#include "render/vocabulary/units.h"
#include "tests/support/cameras.h"

namespace hilcam::extremes {

// Per second and unit of irradiance at the aperture [W m^-2 um^-1] of a bin: A T eta int lambda / (h c)
// dlambda.
inline double electrons_per_irradiance(const CameraModel& c, double from_um, double to_um) {
    const double diameter_m = c.focal_length_m / c.f_number;
    const double per_joule =
        1e-6 * 0.5 * (to_um * to_um - from_um * from_um) / (kPlanck_j_s * kSpeedOfLight_m_s);
    return kPi / 4 * diameter_m * diameter_m * c.transmission.at(0.55) * c.quantum_efficiency.at(0.55) *
           per_joule;
}
// The same of a pixel that looks at an even radiance, on the axis.
inline double electrons_per_radiance(const CameraModel& c, double from_um, double to_um) {
    const double pixel_rad = c.pitch_m / c.focal_length_m;
    return pixel_rad * pixel_rad * c.fill_factor * electrons_per_irradiance(c, from_um, to_um);
}

// Greatest relative error of an FFT pair in single precision over n points, of an image of about one value:
// at most a rounding of each of the two transforms' log2 n levels (Higham, Accuracy and Stability of
// Numerical Algorithms, 2nd ed., 2002, 24.1), and four of its factors.
inline double fft_pair_grain(double n) { return (2 * std::log2(n) + 4) * 0x1p-24; }

}  // namespace hilcam::extremes
