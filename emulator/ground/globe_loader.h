#pragma once
// Makes the ground of a whole body of what a scenario says of it.

#include <memory>
#include <vector>

#include "emulator/ground/globe_config.h"
#include "render/scene/material.h"
#include "render/scene/terrain.h"

namespace hilcam {

// Opens the maps of heights, colours and Hapke's parameters. Throws InputError.
std::vector<GroundMap> open_maps(const GlobeConfig& globe, const MappedBody& body);
// Makes what is below them; what is left to be measured on the maps is. Throws InputError.
std::vector<std::unique_ptr<const GroundDetail>> details_of(const GlobeConfig& globe, const MappedBody& body);
// Makes the boulders, more or fewer by place where maps say so; null: there are none. Throws InputError.
std::unique_ptr<const BoulderField> boulders_of(const GlobeConfig& globe, const MappedBody& body);
// Makes the ground of both, covered with a material. Throws InputError.
std::unique_ptr<Terrain> load_globe(const GlobeConfig& globe, const MappedBody& body,
                                    const Material& material);

}  // namespace hilcam
