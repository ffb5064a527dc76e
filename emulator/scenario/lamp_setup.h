#pragma once
// Makes a scenario's lamps for the renderer, and for the world state that moves and switches them.

#include <vector>

#include "emulator/scenario/app_config.h"
#include "emulator/world/world_lamps.h"
#include "render/scene/lamp.h"

namespace hilcam {

// Both throw InputError that names the lamp.
std::vector<LampMount> lamp_mounts(const ScenarioConfig& scenario);
std::vector<SceneLamp> scene_lamps(const ScenarioConfig& scenario, const SpectralGrid& grid);

}  // namespace hilcam
