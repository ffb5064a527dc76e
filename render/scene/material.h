#pragma once
// The material of a surface: a reflection model with its spectra. brdf.h says how it scatters light.
//
// Models (`model:` in a material file), with what `reflectance` is in each:
//   lambert          albedo of an ideal diffuse surface (Lambert 1760)
//   oren_nayar       albedo of the facets of a rough diffuse surface (brdf_diffuse.h)
//   metal            reflectance at normal incidence; GGX facets with Schlick's Fresnel term
//   dielectric       albedo of the diffuse body under a clear GGX layer with the exact Fresnel term
//   mirror           reflectance at normal incidence, exact reflection
//   glass            not used; a thin clear sheet, `transmittance` inside it at normal incidence
//   phong            diffuse part k_d; `specular` is k_s, `exponent` n (legacy data)
//   lommel_seeliger  I/F at normal incidence and zero phase
//   hapke            single-scattering albedo w (render/sky/regolith.h)
//   table            a factor on a measured BRDF (brdf_table.h)
// metal and dielectric keep all energy: what leaves the facets after several reflections (metal: Kulla &
// Conty, SIGGRAPH 2017 course) or enters the body (dielectric: Kelemen & Szirmay-Kalos, Eurographics 2001
// short papers) is the base lobe (1-E(no))(1-E(ni)) / (pi (1-E_avg)), E the directional albedo of the facets'
// single reflection. Emission: a grey-by-bin body of 1 - reflectance (Kirchhoff 1860) at `temperature_k`. Not
// modelled: polarisation, anisotropy, fluorescence, subsurface transport.

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "render/sky/regolith.h"
#include "render/vocabulary/config_field.h"
#include "render/vocabulary/mesh.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

class BrdfTable;

enum class ReflectionModel {
    kLambert,
    kMetal,
    kDielectric,
    kMirror,
    kGlass,
    kOrenNayar,
    kPhong,
    kLommelSeeliger,
    kHapke,
    kTable
};

// A material as a file gives it.
struct MaterialConfig {
    std::string source;  // source of the figures
    ReflectionModel model = ReflectionModel::kLambert;
    Curve reflectance = Curve::constant(0.5);
    double roughness = 0.3;         // metal, dielectric: GGX alpha is its square; oren_nayar: r
    double refractive_index = 1.5;  // dielectric, glass
    Curve transmittance = Curve::constant(1);
    Curve specular = Curve::constant(0);
    double exponent = 10;
    double lobe_width = 0.25, lobe_backward = 0.5;  // Hapke's b and c
    double surge_amplitude = 0, surge_width = 0.05;
    double slope_rad = 0;         // Hapke's mean slope theta-bar
    double temperature_k = 0;     // 0: no emission
    std::filesystem::path table;  // a measured BRDF: MERL's .binary or our CSV
};
Fields fields(MaterialConfig& config);
// Refuses what would create energy. InputError.
void validate(const MaterialConfig& config);

// A surface of a mesh and what covers it.
struct SurfaceConfig {
    std::string name;  // name of the mesh's surface; "*" is a prefix match ("mli_*")
    MaterialConfig material;
};
Fields fields(SurfaceConfig& config);

// The directional albedo E of a facet lobe over the cosine to the normal, and its cosine-weighted mean.
struct LobeAlbedo {
    static constexpr int kSteps = 32;
    std::array<float, kSteps + 1> at_cosine{};
    float average = 0;

    float operator()(float cosine) const {
        const float x = std::min(std::max(cosine, 0.0f), 1.0f) * kSteps;
        const int i = std::min(static_cast<int>(x), kSteps - 1);
        const float left = at_cosine[static_cast<std::size_t>(i)];
        return left + (x - static_cast<float>(i)) * (at_cosine[static_cast<std::size_t>(i) + 1] - left);
    }
};
// Returns the albedo of GGX facets that reflect everything (refractive_index 0) or as a dielectric. Midpoint
// sums over visible normals: good to 1e-3.
LobeAlbedo ggx_albedo(float alpha, float refractive_index);

// A material on the run's spectral grid. For rays.
struct Material {
    ReflectionModel model = ReflectionModel::kLambert;
    Spectrum base;        // albedo of the diffuse part; w of the regolith models; factor of a table
    Spectrum highlight;   // F0 of metal and mirror; k_s of Phong; transmittance of glass
    float ggx_alpha = 0;  // 0: an exact mirror on top
    float refractive_index = 1;
    float roughness = 0;  // oren_nayar
    float exponent = 0;   // phong
    LobeAlbedo facets;    // metal, dielectric
    HapkeParameters hapke;
    std::shared_ptr<const BrdfTable> table;  // shared: several surfaces may be of one measured material
    Spectrum emission;                       // radiance of its own [W m^-2 sr^-1 um^-1]
    int texture = -1;  // into the object's textures; scales base, or the highlight of metals and mirrors

    bool has_facets() const {
        return model == ReflectionModel::kMetal || model == ReflectionModel::kDielectric ||
               model == ReflectionModel::kMirror;
    }
};

// Throws InputError where a curve does not cover the grid. `table` is for model table alone.
Material make_material(const MaterialConfig& config, const SpectralGrid& grid,
                       std::shared_ptr<const BrdfTable> table = nullptr);
// The mesh's own colours, for surfaces that no config names. Linear sRGB primaries are taken as three broad
// bands (below 0.49 um blue, to 0.58 um green, above red): a stand-in with the right colour, not a measured
// spectrum.
Material make_material(const MeshSurface& surface, const SpectralGrid& grid);
// Returns the first config whose name matches, or null.
const SurfaceConfig* find_surface(std::span<const SurfaceConfig> configs, const std::string& name);

}  // namespace hilcam
