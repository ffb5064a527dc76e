#pragma once
// Builds the ground of a whole body from its section of a scenario.

#include <memory>
#include <vector>

#include "emulator/ground/globe_config.h"
#include "render/scene/material.h"
#include "render/scene/terrain.h"

namespace hilcam {

// Opens the maps of heights, colours and Hapke parameters. Throws InputError.
std::vector<GroundMap> open_maps(const GlobeConfig& globe, const MappedBody& body);
// Builds the detail below the maps' resolution. Parameters that the scenario leaves out are measured on the
// maps. Throws InputError.
std::vector<std::unique_ptr<const GroundDetail>> details_of(const GlobeConfig& globe, const MappedBody& body);
// Builds the boulders, with a density that varies where maps give one; null: no boulders. Throws InputError.
std::unique_ptr<const BoulderField> boulders_of(const GlobeConfig& globe, const MappedBody& body);
// Builds the ground from maps and detail, with a material on it. Throws InputError.
std::unique_ptr<Terrain> load_globe(const GlobeConfig& globe, const MappedBody& body,
                                    const Material& material);

}  // namespace hilcam
