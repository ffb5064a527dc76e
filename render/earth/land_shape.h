#pragma once
// The angular law of land's reflection. Land is brighter towards the Sun (the hot spot), where gaps and
// leaves hide their own shadows.
//
// R = f_iso + f_vol K_vol + f_geo K_geo. K_vol is scattering in a canopy (RossThick: Ross 1981; Roujean et
// al., J. Geophys. Res. 97, 20455, 1992). K_geo is shadows between crowns (LiSparse, reciprocal: Wanner, Li &
// Strahler, J. Geophys. Res. 100, 21077, 1995; h/b = 2, b/r = 1). Both are as in MODIS' albedo product
// (Lucht, Schaaf & Strahler, IEEE Trans. Geosci. Remote Sens. 38, 977, 2000). One set of weights holds for
// all land: the means of land without snow over the globe and a year (Roy et al., Remote Sens. Environ. 176,
// 255, 2016, table 5).
//
// The kernels lack the narrow peak within some 2 degrees of the hot spot. They are not made for elevations
// below 10 degrees; their values at 10 degrees hold there.

#include "render/vocabulary/spectrum.h"

namespace hilcam {

// The kernels at cosines of the zenith angles of Sun and viewer (above 0) and of the azimuth between them (1
// on the same side).
struct LandKernels {
    float volume, geometry;
};
LandKernels land_kernels(float mu0, float mu, float cos_azimuth);

class LandShape {
  public:
    explicit LandShape(const SpectralGrid& grid);
    // Returns the reflection of the Sun's beam, relative to a diffuse surface with the same albedo under a
    // uniform sky, per bin. cos_phase: cosine of the angle between the directions to Sun and
    // viewer. Loop, any thread.
    Spectrum of(float mu0, float mu, float cos_phase) const;

  private:
    Spectrum even_, volume_, geometry_;
};

}  // namespace hilcam
