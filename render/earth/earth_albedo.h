#pragma once
// The Earth's maps as the air above them has them: land, sea and clouds as one diffuse albedo by place, for the light that goes
// between ground and sky.
//
//   ground   the map's land, and the sea by its albedo
//   cloud    reflects c = b tau / (1 + b tau) of diffuse light, which is a two-stream layer's albedo (Bohren, Am. J. Phys. 55,
//            524, 1987), whatever its height, and lets the rest through; between the two light goes up and down
// Of maps by time the mean counts.

#include "render/earth/cloud_maps.h"
#include "render/earth/earth_config.h"
#include "render/earth/ground_maps.h"
#include "render/sky/air_by_place.h"

namespace hilcam {

// clouds: empty where they are the ground's.
AirGround earth_albedo(const EarthConfig& config, const GroundMaps& ground, const CloudMaps& clouds,
                       const SpectralGrid& grid);

}  // namespace hilcam
