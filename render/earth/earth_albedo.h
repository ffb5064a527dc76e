#pragma once
// The Earth's maps for the air above them: land, sea and clouds as one diffuse albedo by place, for light
// that is reflected between ground and sky.
//
//     ground   the map's land, and the sea by its albedo
//     cloud    reflects c = b tau / (1 + b tau) of diffuse light, the albedo of a two-stream layer (Bohren,
//              Am. J. Phys. 55, 524, 1987), at any height, and transmits the rest; light is reflected back
//              and forth between the two
// Maps by time are averaged.

#include "render/earth/cloud_maps.h"
#include "render/earth/earth_config.h"
#include "render/earth/ground_maps.h"
#include "render/sky/air_by_place.h"

namespace hilcam {

// clouds: empty if the ground's maps contain them.
AirGround earth_albedo(const EarthConfig& config, const GroundMaps& ground, const CloudMaps& clouds,
                       const SpectralGrid& grid);

}  // namespace hilcam
