#pragma once
// From a scenario to what the renderer needs: meshes, materials, stars, Earth.

#include "emulator/app_config.h"
#include "render/scene.h"

namespace hilcam {

// Loads every file the scenario names, making generated meshes if need be. Throws InputError or DeviceError.
Scene load_scene(const ScenarioConfig& scenario, const SpectralGrid& grid);

}  // namespace hilcam
