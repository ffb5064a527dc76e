#pragma once
// `table`: an atmosphere as another program computed it (MODTRAN, 6S, libRadtran), on a grid of geometries.
//
// The grid's axes are those of a ground point: zenith angle of the Sun, zenith angle of the viewer, azimuth
// between the two (0: on the same side), height of the viewer; linear between grid points. The greatest
// height stands for all above it. A table says nothing of rays that miss the ground: they are taken as clear.
// A geometry outside the grid is never extrapolated in silence: covers() says so before a run, and rays that
// leave the grid during one are counted.

#include <array>
#include <vector>

#include "render/vocabulary/spectrum.h"

namespace hilcam {

struct AtmosphereTable {
    // tau_1: Sun to ground, tau_2: ground to viewer; path radiance [sr^-1] and the sky's irradiance on the
    // ground [1] per unit of solar irradiance.
    struct Cell {
        Spectrum tau_1, tau_2, radiance_sr, sky;
    };
    enum Axis { kSunZenith, kViewZenith, kAzimuth, kHeight, kAxes };

    std::array<std::vector<double>, kAxes> axes;  // increasing [rad, rad, rad, m]
    std::vector<Cell> cells;                      // last axis fastest
};

}  // namespace hilcam
