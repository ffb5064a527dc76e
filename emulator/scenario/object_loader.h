#pragma once
// Loads the objects of a scenario: meshes, levels of detail, albedos and materials.

#include <cstddef>
#include <string>
#include <vector>

#include "emulator/scenario/app_config.h"
#include "emulator/scenario/light_loader.h"
#include "render/scene/scene.h"

namespace hilcam {

// A surface of a loaded object, for people: over the mesh with all its parts, in its own axes.
struct LoadedSurface {
    std::string name;
    std::size_t triangles = 0;
    double area_m2 = 0;
    std::string rule;  // rule of the object's materials that applies to it; empty: look from the mesh file
    double reflectance = 0;  // approximate share of sunlight reflected in all directions
    Spectrum emission;       // radiance by its temperature [W m^-2 sr^-1 um^-1]
};
struct LoadedObject {
    std::string name;
    Vec3d min_m, max_m;
    std::size_t triangles = 0;
    std::vector<LoadedSurface> surfaces;
    std::vector<std::string> idle_rules;  // material rules that apply to no surface
    std::vector<std::string> left_out;    // looks in the mesh file that are not used (Mesh::left_out)

    double mean_reflectance() const;  // weighted by area
    Spectrum mean_emission() const;   // the same
};

// Loads a scenario's objects, each kind once, and puts them into the scene at their sizes and with their
// transfer tables: first the objects in order, then all their parts on joints, as WorldState places them.
// found: receives what was found, in the same order. Throws InputError or DeviceError.
void load_objects(const ScenarioConfig& scenario, const SpectralGrid& grid, LightLoading& light, Scene& scene,
                  std::vector<LoadedObject>& found);

// Returns a name for the file of an object's mesh; objects with the same name share a mesh. Throws
// InputError.
std::string mesh_name_of(const ObjectConfig& object);
// Loads an object's mesh with all its parts at their zero angles, in the object's axes and at its scale.
// Generates the file if necessary. Throws InputError or DeviceError.
Mesh load_whole_mesh(const ObjectConfig& object);
// Makes a material, loading the table that it names. Throws InputError.
Material load_material(const MaterialConfig& config, const SpectralGrid& grid);

}  // namespace hilcam
