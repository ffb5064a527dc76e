#pragma once
// The material of a surface: a reflection model (render/brdf) with its spectra. brdf.h says how it scatters
// light.
//
// Emission: a grey-by-bin body of 1 - reflectance (Kirchhoff 1860) at `temperature_k`. Not modelled:
// polarisation, anisotropy, fluorescence, subsurface transport.

#include <memory>
#include <span>
#include <string>

#include "render/brdf/brdf_models.h"
#include "render/vocabulary/config_field.h"
#include "render/vocabulary/mesh.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

// A material as a file gives it: keys that models share, and those of each model.
using MaterialConfig = BrdfModels::Keys;
Fields fields(MaterialConfig& config);
// Refuses what would create energy. InputError.
void validate(const MaterialConfig& config);

// A surface of a mesh and what covers it.
struct SurfaceConfig {
    std::string name;  // name of the mesh's surface; "*" is a prefix match ("mli_*")
    MaterialConfig material;
};
Fields fields(SurfaceConfig& config);

// A material on the run's spectral grid. For rays.
struct Material {
    Brdf brdf;
    Spectrum base, highlight;  // spectra as BsdfInputs has them
    float ggx_alpha = 0;       // 0: an exact mirror on top
    Spectrum emission;         // radiance of its own [W m^-2 sr^-1 um^-1]
    int texture = -1;  // into the object's textures; scales base, and the highlight where there is no body
    bool colored = false;  // the mesh has colours at its corners, which scale the same

    bool varies() const { return texture >= 0 || colored; }
    const BrdfTraits& traits() const { return kBrdfTraits[brdf.index()]; }
    bool has_facets() const { return traits().has_facets; }
    bool transmits() const { return traits().transmits; }
    // Facets are all there is: a metal or a mirror.
    bool is_bare() const { return has_facets() && !traits().has_body; }
};

// Throws InputError where a curve does not cover the grid. `table` is for a model that takes one.
Material make_material(const MaterialConfig& config, const SpectralGrid& grid,
                       std::shared_ptr<const BrdfTable> table = nullptr);
// The mesh's own colours, for surfaces that no config names. Linear sRGB primaries are taken as three broad
// bands (below 0.49 um blue, to 0.58 um green, above red): a stand-in with the right colour, not a measured
// spectrum.
Material make_material(const MeshSurface& surface, const SpectralGrid& grid);
// Returns the first config whose name matches, or null.
const SurfaceConfig* find_surface(std::span<const SurfaceConfig> configs, const std::string& name);

}  // namespace hilcam
