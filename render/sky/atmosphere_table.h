#pragma once
// `table`: an atmosphere that another program has computed (MODTRAN, 6S, libRadtran) on a grid of geometries.
//
// The axes belong to a ground point: zenith angle of the Sun, zenith angle of the viewer, azimuth between the
// two (0: on the same side), height of the viewer; linear between grid points. The largest height also holds
// above it. A table has no data for rays that miss the ground, which count as clear. Nothing outside the grid
// is extrapolated silently: Atmosphere::missing() reports it before a run, and rays that leave the grid
// during a run are counted.

#include <array>
#include <vector>

#include "render/vocabulary/spectrum.h"

namespace hilcam {

struct AtmosphereTable {
    // tau_1: Sun to ground, tau_2: ground to viewer; path radiance [sr^-1] and the sky's irradiance on the
    // ground [1], per unit of solar irradiance.
    struct Cell {
        Spectrum tau_1, tau_2, radiance_sr, sky;
    };
    enum Axis { kSunZenith, kViewZenith, kAzimuth, kHeight, kAxes };

    std::array<std::vector<double>, kAxes> axes;  // increasing [rad, rad, rad, m]
    std::vector<Cell> cells;                      // last axis fastest
};

}  // namespace hilcam
