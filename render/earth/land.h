#pragma once
// Land and ice: reflectance in four bands, distributed over the spectral bins. Snow is diffuse (Lambert);
// land_shape.h has the angular law of the other land.
//
// A map of colours has no more than that. Between the bands reflectance changes along ramps: 0.48 to 0.50 um,
// 0.57 to 0.59 um, and 0.68 to 0.74 um for the rise of plants' reflectance, as in the canopy of
// configs/materials/vegetation.yaml (PROSAIL: Jacquemoud et al., Remote Sens. Environ. 113, 2009). Not
// modelled: angular laws that differ from place to place, shading by terrain.

#include <algorithm>

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

    // Returns the share of the land that is not snow. In the blue, vegetation, soil and sand are darker than
    // 0.3 and snow is brighter than 0.55 (configs/materials/vegetation.yaml, snow.yaml; Libya-4 has 0.25).
    static float without_snow(const EarthSample& sample) {
        const float blue = sample.land(0) / std::max(0.02f, 1 - sample.water());
        return std::clamp((0.55f - blue) / 0.25f, 0.0f, 1.0f);
    }

  private:
    std::array<Spectrum, 4> band_;  // they sum to 1 in every bin
};

}  // namespace hilcam
