#pragma once
// Builds what the renderer needs from a scenario: models, meshes, materials, stars, bodies, air.

#include "emulator/scenario/app_config.h"
#include "emulator/scenario/light_loader.h"
#include "emulator/scenario/object_loader.h"
#include "render/frame/renderer.h"
#include "render/paths/modules.h"
#include "render/scene/scene.h"

namespace hilcam {

// Loads every file the scenario names, making generated meshes if need be. Throws InputError or DeviceError.
// found: gets the objects in their order; light: how the scene is to get its transfer tables, and what
// came of it; null: nobody wants to know, and tables are made at once.
Scene load_scene(const ScenarioConfig& scenario, const SpectralGrid& grid, const Modules& modules,
                 std::vector<LoadedObject>* found = nullptr, LightLoading* light = nullptr);
// The same, ready to render.
std::unique_ptr<Renderer> load_renderer(const ScenarioConfig& scenario, const SpectralGrid& grid,
                                        const ImageGeometry& geometry,
                                        std::vector<LoadedObject>* found = nullptr,
                                        LightLoading* light = nullptr);

// Finds the body whose ground the scenario's terrain.globe is. Throws InputError where there is no such body.
MappedBody ground_body(const ScenarioConfig& scenario);
BodyId ground_body_id(const ScenarioConfig& scenario);

// Loads what the maps of the camera's fixed_pattern hold.
DetectorPictures load_detector_pictures(const CameraModel& camera);

}  // namespace hilcam
