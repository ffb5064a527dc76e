#pragma once
// Builds what the renderer needs from a scenario: models, meshes, materials, stars, bodies, air.

#include "emulator/scenario/app_config.h"
#include "emulator/scenario/light_loader.h"
#include "render/frame/renderer.h"
#include "render/paths/modules.h"
#include "render/scene/scene.h"

namespace hilcam {

// A surface that was found when an object was loaded, for people: its mesh with all its parts, in its own
// axes.
struct LoadedSurface {
    std::string name;
    std::size_t triangles = 0;
    double area_m2 = 0;
    std::string rule;        // rule of the object's materials that it took; empty: the mesh's own look
    double reflectance = 0;  // share of sunlight that comes back in all directions, about
};
struct LoadedObject {
    std::string name;
    Vec3d least_m, most_m;
    std::size_t triangles = 0;
    std::vector<LoadedSurface> surfaces;
    std::vector<std::string> idle_rules;  // rules of its materials that no surface takes
    std::vector<std::string> left_out;    // looks of its mesh file that are not used (Mesh::left_out)

    double mean_reflectance() const;  // by area
};

// Loads every file the scenario names, making generated meshes if need be. Throws InputError or DeviceError.
// found: gets the objects in their order; light: how the scene is to get its tables of directions, and what
// came of it; null: nobody wants to know, and tables are made at once.
Scene load_scene(const ScenarioConfig& scenario, const SpectralGrid& grid, const Modules& modules,
                 std::vector<LoadedObject>* found = nullptr, LightLoading* light = nullptr);
// The same, ready to render.
std::unique_ptr<Renderer> load_renderer(const ScenarioConfig& scenario, const SpectralGrid& grid,
                                        const ImageGeometry& geometry,
                                        std::vector<LoadedObject>* found = nullptr,
                                        LightLoading* light = nullptr);

// Returns a name of the file of an object's mesh: objects of one name have one mesh. Throws InputError.
std::string mesh_name_of(const ObjectConfig& object);
// Loads an object's mesh with all its parts, unturned, in the object's axes and at its scale; its file is made if
// need be. Throws InputError or DeviceError.
Mesh load_whole_mesh(const ObjectConfig& object);
// Finds the body whose ground the scenario's terrain.globe is. Throws InputError where there is no such body.
MappedBody ground_body(const ScenarioConfig& scenario);
BodyId ground_body_id(const ScenarioConfig& scenario);

// Loads what the maps of the camera's fixed_pattern hold.
DetectorPictures load_detector_pictures(const CameraModel& camera);

}  // namespace hilcam
