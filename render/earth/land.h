#pragma once
// Land and ice: four bands of reflectance laid onto the spectral bins. Snow reflects evenly, the rest of the land by its shape (land_shape.h).
//
// A map of colours holds no more than that. Between the bands reflectance changes over ramps: 0.48 to 0.50 um, 0.57 to
// 0.59 um, and the rise of plants' reflectance from 0.68 to 0.74 um, which is where the canopy of
// configs/materials/vegetation.yaml (PROSAIL: Jacquemoud et al., Remote Sens. Environ. 113, 2009) has it.
// What it does not model: other shapes from place to place, terrain's shading.

#include <algorithm>

#include "render/earth/earth_map.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

class LandBands {
  public:
    explicit LandBands(const SpectralGrid& grid);
    // Reflectance of the land of a texel, times its share of the ground.
    Spectrum reflectance(const EarthSample& sample) const {
        Spectrum out = sample.land(0) * band_[0];
        for (int i = 1; i < 4; ++i) out += sample.land(i) * band_[static_cast<std::size_t>(i)];
        return out;
    }

    // Returns the share of the land that is not snow: in the blue, vegetation, soil and sand are darker than 0.3, snow is brighter than 0.55
    // (configs/materials/vegetation.yaml, snow.yaml; Libya-4 has 0.25).
    static float without_snow(const EarthSample& sample) {
        const float blue = sample.land(0) / std::max(0.02f, 1 - sample.water());
        return std::clamp((0.55f - blue) / 0.25f, 0.0f, 1.0f);
    }

  private:
    std::array<Spectrum, 4> band_;  // they sum to 1 in every bin
};

}  // namespace hilcam
