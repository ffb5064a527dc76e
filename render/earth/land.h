#pragma once
// Land and ice: reflectance in four bands, distributed over the spectral bins; diffuse (Lambert).
//
// A map of colours has no more than that. Between the bands reflectance changes along ramps: 0.48 to 0.50 um,
// 0.57 to 0.59 um, and 0.68 to 0.74 um for the rise of plants' reflectance, as in the canopy of
// configs/materials/vegetation.yaml (PROSAIL: Jacquemoud et al., Remote Sens. Environ. 113, 2009). Not
// modelled: the hot spot and other angular effects, shading by terrain.

#include "render/earth/earth_map.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

class LandBands {
  public:
    explicit LandBands(const SpectralGrid& grid);
    // Returns the reflectance of the land in a texel, times its share of the ground.
    Spectrum reflectance(const EarthSample& sample) const {
        Spectrum out = sample.land(0) * band_[0];
        for (int i = 1; i < 4; ++i) out += sample.land(i) * band_[static_cast<std::size_t>(i)];
        return out;
    }

  private:
    std::array<Spectrum, 4> band_;  // they sum to 1 in every bin
};

}  // namespace hilcam
