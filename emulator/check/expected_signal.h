#pragma once
// Estimates how bright an object will be in the picture before anything is rendered.
//
// It is taken for a sphere that spreads sunlight as Lambert's law has it, of the mean reflectance of its
// surfaces by area: the mean over the lit part of its disk is
//     L = rho E / (pi r^2) * s * [2/3 (sin a + (pi - a) cos a) / pi] / [(1 + cos a) / 2]
// with rho the reflectance, E the Sun's irradiance at 1 au, r the Sun's distance [au], s the share of the Sun
// that bodies leave, a the phase angle. The bracket over the bracket is the Lambert sphere's phase law
// (Russell, Astrophysical Journal 43, 1916, p. 173) over the lit share of the disk. Left out: shape, shadows
// and glints, textures, lamps and light from bodies; so it says which exposure is meant, within some factor
// of two, and not what a pixel will have. What is smaller than a few pixels has the light of its lit part in
// the pixel that it is centred on.

#include "emulator/check/camera_sheet.h"

namespace hilcam {

struct LitObject {
    double reflectance = 0;
    double phase_rad = 0;
    double sun_au = 1;
    double sunlit = 1;   // share of the Sun
    double area_px = 0;  // area of its whole disk, lit and dark
};

struct ExpectedSignal {
    double signal_e = 0;    // electrons of light, without saturation
    double dn = 0;          // number with black level and dark current, as the converter ends
    double full_scale = 0;  // share of what the pixel can hold, dark current included; above 1: saturated
    double snr = 0;
};

ExpectedSignal expected_signal(const CameraSheet& camera, const LitObject& object);

// Returns what a pixel makes of so many electrons of light.
ExpectedSignal read_out(const CameraSheet& camera, double signal_e);

// Share of a sphere's disk that is lit.
double lit_share(double phase_rad);

}  // namespace hilcam
