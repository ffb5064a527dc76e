#pragma once
// The shape of land's reflection, which differs by direction: brighter towards the Sun's side (the hot spot), where gaps and leaves hide their own shadows.
//
// R = f_iso + f_vol K_vol + f_geo K_geo, with the kernels of scattering in a canopy (RossThick: Ross 1981; Roujean et al., J. Geophys. Res.
// 97, 20455, 1992) and of shadows between crowns (LiSparse, reciprocal: Wanner, Li & Strahler, J. Geophys. Res. 100, 21077, 1995; h/b = 2,
// b/r = 1), as MODIS' albedo product has them (Lucht, Schaaf & Strahler, IEEE Trans. Geosci. Remote Sens. 38, 977, 2000). Their weights are
// the means of land without snow over the globe and a year (Roy et al., Remote Sens. Environ. 176, 255, 2016, table 5), one set for all land:
// a place's own differ.
//
// The narrow peak within some 2 degrees of the hot spot is not in these kernels. Steeper than 10 degrees over the level shapes are those of 10
// degrees, as kernels are not made for less.

#include "render/vocabulary/spectrum.h"

namespace hilcam {

// The kernels at cosines of the zenith angles of Sun and viewer, above 0, and of the azimuth between them, 1 on the same side.
struct LandKernels {
    float volume, geometry;
};
LandKernels land_kernels(float mu0, float mu, float cos_azimuth);

class LandShape {
  public:
    explicit LandShape(const SpectralGrid& grid);
    // Returns reflection of the Sun's beam over that of an even surface which has the same albedo under an even sky, per bin. cos_phase: of the
    // angle between the directions to Sun and viewer. Loop, any thread.
    Spectrum of(float mu0, float mu, float cos_phase) const;

  private:
    Spectrum even_, volume_, geometry_;
};

}  // namespace hilcam
