#pragma once
// The material of a surface: a reflection model (render/brdf) with its spectra. brdf.h says how it scatters
// light.
//
// In thermal bins (spectrum.h) the model is given the reflectance with which it reflects 1 - emissivity of
// light from all directions. Emission: thermal_emission.h. Not modelled: polarisation, anisotropy,
// fluorescence, subsurface transport.

#include <memory>
#include <span>
#include <string>

#include "render/brdf/brdf_models.h"
#include "render/scene/thermal_emission.h"
#include "render/vocabulary/config_field.h"
#include "render/vocabulary/mesh.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

// A material as a file gives it: keys that all models share, and the keys of each model.
using MaterialConfig = BrdfModels::Keys;
Fields fields(MaterialConfig& config);
// Throws InputError if the material would create energy.
void validate(const MaterialConfig& config);

// A surface of a mesh and its material.
struct SurfaceConfig {
    std::string name;  // name of the mesh's surface; "*" at the end matches any ending ("mli_*")
    MaterialConfig material;
    double temperature_k = 0;  // in place of the material's
    bool has_temperature = false;
};
Fields fields(SurfaceConfig& config);

// A material on the run's spectral grid, as rays use it.
struct Material {
    Brdf brdf;
    Spectrum base, highlight;  // spectra, see BsdfInputs
    float ggx_alpha = 0;       // 0: an exact mirror
    ThermalEmission emission;
    int texture = -1;  // index of the object's textures; scales base, or the highlight if there is no body
    bool colored = false;  // the mesh has vertex colours, which scale the same spectra

    bool varies() const { return texture >= 0 || colored; }
    const BrdfTraits& traits() const { return kBrdfTraits[brdf.index()]; }
    bool has_facets() const { return traits().has_facets; }
    bool transmits() const { return traits().transmits; }
    // True when the surface consists of facets only: a metal or a mirror.
    bool is_bare() const { return has_facets() && !traits().has_body; }
};

// Throws InputError if a curve does not cover the grid, or the thermal bins have no emissivity. `table` is
// for models that use one.
Material make_material(const MaterialConfig& config, const SpectralGrid& grid,
                       std::shared_ptr<const BrdfTable> table = nullptr);
// Makes the material of a surface that no config names, from the mesh's own colours. Linear sRGB values
// become three broad bands (blue below 0.49 um, green to 0.58 um, red above): the right colour, but not a
// measured spectrum. Thermal bins have the emissivity of most paints, or of bare metals.
Material make_material(const MeshSurface& surface, const SpectralGrid& grid);
// Paints of any colour and anodised aluminium have 0.80 to 0.92, bare metals 0.02 to 0.2 (Gilmore, Spacecraft
// Thermal Control Handbook, 2002, app. A).
inline constexpr double kUnknownEmissivity = 0.85, kUnknownMetalEmissivity = 0.1;
// Gives a material another temperature [K]; 0: it emits nothing.
void set_temperature(Material& material, const SpectralGrid& grid, double temperature_k);
// Returns the first config whose name matches, or null.
const SurfaceConfig* find_surface(std::span<const SurfaceConfig> configs, const std::string& name);

}  // namespace hilcam
