#pragma once
// Estimates how bright an object will be in the picture before anything is rendered.
//
// The object is treated as a sphere with Lambert's law and the mean reflectance of its surfaces, weighted by
// area. The mean radiance over the lit part of its disk is
//     L = rho E / (pi r^2) * s * [2/3 (sin a + (pi - a) cos a) / pi] / [(1 + cos a) / 2]
// with rho the reflectance, E the Sun's irradiance at 1 au, r the Sun's distance [au], s the visible share of
// the Sun's disk where bodies cover part of it, and a the phase angle. The first bracket is the Lambert
// sphere's phase law (Russell, Astrophysical Journal 43, 1916, p. 173), the second the lit share of the disk.
//
// To this comes what it emits by its temperature, the mean over its surfaces.
//
// Ignored: shape, shadows, glints, textures, lamps, and light from bodies. The estimate is good to about a
// factor of two: enough to choose an exposure, not to predict a pixel. An object with a lit part of fewer
// than 4 pixels counts as a point of light centred on one pixel.

#include "emulator/check/camera_sheet.h"

namespace hilcam {

struct LitObject {
    double reflectance = 0;
    double phase_rad = 0;
    double sun_au = 1;
    double sunlit = 1;     // visible share of the Sun's disk
    double area_px = 0;    // whole disk, lit and dark
    double emitted_e = 0;  // by its own temperature, of each pixel on it
};

struct ExpectedSignal {
    double signal_e = 0;    // electrons of light, without saturation
    double dn = 0;          // digital number with black level and dark current, limited by the converter
    double full_scale = 0;  // share of the pixel's capacity, including dark current; above 1: saturated
    double snr = 0;
};

ExpectedSignal expected_signal(const CameraSheet& camera, const LitObject& object);

// Returns a pixel's reading for a number of electrons of light.
ExpectedSignal read_out(const CameraSheet& camera, double signal_e);

// Returns the lit share of a sphere's disk.
double lit_share(double phase_rad);

}  // namespace hilcam
