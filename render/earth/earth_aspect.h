#pragma once
// Everything that a look at the Earth depends on except its maps. It varies slowly over a picture, so a patch
// of pixels can share it (earth_patch.h). Light is per unit of solar irradiance.

#include <array>

#include "render/earth/earth_map.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

struct EarthAspect {
    // Cloud tables are sampled at c = (k / 8)^2, where c is EarthSample::cloud().
    static constexpr int kSteps = 9;
    using Steps = std::array<float, kSteps>;
    // The air is known at two heights; in between, what is above a height varies as the air does.
    static constexpr float kHigh_m = 8000;

    // Figures at the ground and at kHigh_m: radiance of the air in front [sr^-1] and its transmittance;
    // irradiance by the Sun and by the sky.
    Spectrum air_low, seen_low, sun_low, sky_low;
    Spectrum air_high, seen_high, sun_high, sky_high;
    // Cloud reflection is many + share * once.
    Spectrum once;
    Spectrum land_shape;  // reflection of the beam by land without snow, over that of a diffuse surface
    Steps many{}, share{};
    Steps seen{};  // share of light from below that reaches the viewer
    Steps lit{};   // share of sunlight that comes down, including the beam
    Steps beam{};  // the beam's part of it
    float glint_sr = 0, mirrored = 0;
    // Places on the map: of the ground; and the offsets, per metre of height, to where clouds are met and
    // where shadows come from.
    float u = 0, v = 0, cloud_u = 0, cloud_v = 0, shade_u = 0, shade_v = 0;
    MapFootprint footprint;
    std::array<float, 7> unused{};
};
static_assert(sizeof(EarthAspect) == 144 * sizeof(float));

}  // namespace hilcam
