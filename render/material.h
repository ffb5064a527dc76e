#pragma once
// Surface reflection: Lambert below an optional GGX layer.
//
// f = f_spec + f_diff [sr^-1]
//   f_spec = D G2 F / (4 cos_i cos_o): GGX normal distribution and Smith height-correlated shadowing (Walter
//   et al.,
//            EGSR 2007; Heitz, JCGT 3(2), 2014), Fresnel by Schlick (Computer Graphics Forum 13(3), 1994).
//   f_diff = (1 - F0_mean) albedo / pi for dielectrics, 0 for metals (Lambert).
// Not modelled: light that scatters several times between facets, polarisation, transmission, anisotropy.

#include <span>
#include <string>
#include <vector>

#include "render/config_field.h"
#include "render/mesh.h"
#include "render/spectrum.h"

namespace hilcam {

enum class ReflectionModel { kLambert, kMetal, kDielectric, kMirror };

// A material as a scenario gives it.
struct MaterialConfig {
    std::string name;    // matches surfaces of the mesh; "*" is a prefix match ("mli_*")
    std::string source;  // where the figures come from
    ReflectionModel model = ReflectionModel::kLambert;
    Curve reflectance =
        Curve::constant(0.5);  // albedo of Lambert and dielectric, normal reflectance of metal and mirror
    double roughness = 0.3;    // perceptual, 0..1; GGX alpha = roughness^2
    double refractive_index = 1.5;  // of a dielectric's clear layer
};
Fields fields(MaterialConfig& config);

// A material on the run's spectral grid. For rays.
struct Material {
    Spectrum diffuse_albedo;      // 0..1
    Spectrum normal_reflectance;  // F0, 0..1
    float ggx_alpha = 0;          // 0: no GGX lobe from lights (a mirror, or plain Lambert)
    bool specular = false;        // has a mirror-like or GGX component
    int texture = -1;  // into the object's textures; scales diffuse_albedo, or normal_reflectance of metals
};

Material make_material(const MaterialConfig& config, const SpectralGrid& grid);
// The mesh's own colours, for surfaces that no MaterialConfig names. Linear sRGB primaries are taken as three
// broad bands (below 0.49 um blue, to 0.58 um green, above red): a stand-in with the right colour, not a
// measured spectrum.
Material make_material(const MeshSurface& surface, const SpectralGrid& grid);
// One per surface of the mesh: the first config whose name matches, else the mesh's own look.
std::vector<Material> make_materials(const Mesh& mesh, std::span<const MaterialConfig> configs,
                                     const SpectralGrid& grid);

}  // namespace hilcam
