#pragma once
// Loads the objects of a scenario: their meshes, levels of detail, albedos and materials.

#include <cstddef>
#include <string>
#include <vector>

#include "emulator/scenario/app_config.h"
#include "emulator/scenario/light_loader.h"
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
    Vec3d min_m, max_m;
    std::size_t triangles = 0;
    std::vector<LoadedSurface> surfaces;
    std::vector<std::string> idle_rules;  // rules of its materials that no surface takes
    std::vector<std::string> left_out;    // looks of its mesh file that are not used (Mesh::left_out)

    double mean_reflectance() const;  // by area
};

// Loads the objects of a scenario, each make once, and puts them into the scene: the objects in their order, then all their turning
// parts, as WorldState places them; at their sizes and with their transfer tables. found: gets what was found of the objects, in
// their order. Throws InputError or DeviceError.
void load_objects(const ScenarioConfig& scenario, const SpectralGrid& grid, LightLoading& light, Scene& scene,
                  std::vector<LoadedObject>& found);

// Returns a name of the file of an object's mesh: objects of one name have one mesh. Throws InputError.
std::string mesh_name_of(const ObjectConfig& object);
// Loads an object's mesh with all its parts, unturned, in the object's axes and at its scale; its file is made if
// need be. Throws InputError or DeviceError.
Mesh load_whole_mesh(const ObjectConfig& object);
// Makes a material, with the table that it names. Throws InputError.
Material load_material(const MaterialConfig& config, const SpectralGrid& grid);

}  // namespace hilcam
