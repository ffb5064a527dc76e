#pragma once
// All that a look at the Earth depends on beside its maps: it changes slowly over a picture, so a patch of pixels may
// share it (earth_patch.h). Light per unit of solar irradiance.

#include <array>

#include "render/earth/earth_map.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

struct EarthAspect {
    // Clouds' tables at c = (k / 8)^2, where c is EarthSample::cloud().
    static constexpr int kSteps = 9;
    using Steps = std::array<float, kSteps>;
    // The air is known at two heights; between them what is above a height changes as the air does.
    static constexpr float kHigh_m = 8000;

    // Figures at the ground and at kHigh_m: radiance of the air before it [sr^-1] and what that lets through; the Sun's and the sky's
    // irradiance on the level.
    Spectrum air_low, seen_low, sun_low, sky_low;
    Spectrum air_high, seen_high, sun_high, sky_high;
    // Cloud reflection: many + share * once.
    Spectrum once;
    Spectrum land_shape;  // reflection of land without snow, in the beam, over that of an even surface
    Steps many{}, share{};
    Steps seen{};  // share of light from below on its way to the viewer
    Steps lit{};   // share of sunlight on its way down, the beam included
    Steps beam{};  // the beam's part alone
    float glint_sr = 0, mirrored = 0;
    // Places on the map: of the ground; how far from it clouds are met and shadows come from, per metre of height.
    float u = 0, v = 0, cloud_u = 0, cloud_v = 0, shade_u = 0, shade_v = 0;
    MapFootprint footprint;
    std::array<float, 7> unused{};
};
static_assert(sizeof(EarthAspect) == 144 * sizeof(float));

}  // namespace hilcam
