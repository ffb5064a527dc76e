#pragma once
// From a scenario to the renderer: models, meshes, materials, stars, bodies, air.

#include "emulator/scenario/app_config.h"
#include "render/frame/renderer.h"
#include "render/light/modules.h"
#include "render/scene/scene.h"

namespace hilcam {

// Loads every file the scenario names, making generated meshes if need be. Throws InputError or DeviceError.
Scene load_scene(const ScenarioConfig& scenario, const SpectralGrid& grid, const Modules& modules);
// The same, ready to render.
std::unique_ptr<Renderer> load_renderer(const ScenarioConfig& scenario, const SpectralGrid& grid,
                                        const ImageGeometry& geometry);

// What the maps of the camera's fixed_pattern hold.
DetectorPictures load_detector_pictures(const CameraModel& camera);

}  // namespace hilcam
