#pragma once
// Builds everything that the renderer needs from a scenario: models, meshes, materials, stars, bodies, air.

#include "emulator/scenario/app_config.h"
#include "emulator/scenario/light_loader.h"
#include "emulator/scenario/object_loader.h"
#include "render/frame/renderer.h"
#include "render/paths/modules.h"
#include "render/scene/scene.h"

namespace hilcam {

// Loads every file that the scenario names, generating meshes if necessary. found: receives the objects in
// order. light: says how the scene gets its transfer tables, and receives what happened; null: tables are
// made at once. Throws InputError or DeviceError.
Scene load_scene(const ScenarioConfig& scenario, const SpectralGrid& grid, const Modules& modules,
                 std::vector<LoadedObject>* found = nullptr, LightLoading* light = nullptr);
// Loads the scene into a renderer that is ready to use.
std::unique_ptr<Renderer> load_renderer(const ScenarioConfig& scenario, const SpectralGrid& grid,
                                        const ImageGeometry& geometry,
                                        std::vector<LoadedObject>* found = nullptr,
                                        LightLoading* light = nullptr);

// Return the body whose ground terrain.globe describes. Throw InputError when there is no such body.
MappedBody ground_body(const ScenarioConfig& scenario);
BodyId ground_body_id(const ScenarioConfig& scenario);

// Loads the maps of the camera's fixed_pattern.
DetectorPictures load_detector_pictures(const CameraModel& camera);

}  // namespace hilcam
