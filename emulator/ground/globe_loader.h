#pragma once
// Makes the ground of a whole body of what a scenario says of it.

#include <memory>

#include "emulator/ground/globe_config.h"
#include "render/scene/terrain.h"

namespace hilcam {

// Opens the maps. Throws InputError.
std::unique_ptr<Terrain> load_globe(const GlobeConfig& globe, const MappedBody& body);

}  // namespace hilcam
