#include "render/material.h"

#include <algorithm>
#include <cmath>

namespace hilcam {
namespace {

// Reflectance at normal incidence between air and a dielectric (Fresnel 1823; Born & Wolf, Principles of
// Optics, 7th ed., 1.5.2).
double normal_reflectance_of(double refractive_index) {
    const double r = (refractive_index - 1) / (refractive_index + 1);
    return r * r;
}

bool name_matches(const std::string& pattern, const std::string& name) {
    if (!pattern.empty() && pattern.back() == '*')
        return name.starts_with(pattern.substr(0, pattern.size() - 1));
    return pattern == name;
}

Spectrum scaled(Spectrum spectrum, double factor) {
    for (float& value : spectrum.bin) value *= static_cast<float>(factor);
    return spectrum;
}

}  // namespace

Fields fields(MaterialConfig& c) {
    return {
        required(text("name", c.name, "surface of the mesh that it covers; a trailing * matches any ending")),
        text("source", c.source, "where the figures come from"),
        choice("model", c.model, {"lambert", "metal", "dielectric", "mirror"},
               "lambert: diffuse; metal: GGX; dielectric: diffuse under a clear GGX layer; mirror: exact "
               "reflection"),
        curve("reflectance", c.reflectance, {0, 1},
              "albedo (lambert, dielectric) or reflectance at normal incidence (metal, mirror); number or "
              "[[um, value], ...]"),
        number("roughness", c.roughness, 1, {0, 1},
               "perceptual roughness of metal and dielectric; GGX alpha is its square"),
        number("refractive_index", c.refractive_index, 1, {1, 4}, "of the clear layer of a dielectric"),
    };
}

Material make_material(const MaterialConfig& config, const SpectralGrid& grid) {
    Material material;
    const Spectrum reflectance = grid.average(config.reflectance);
    material.ggx_alpha = static_cast<float>(config.roughness * config.roughness);
    switch (config.model) {
        case ReflectionModel::kLambert:
            material.diffuse_albedo = reflectance;
            material.ggx_alpha = 0;
            break;
        case ReflectionModel::kMetal:
            material.normal_reflectance = reflectance;
            material.specular = true;
            break;
        case ReflectionModel::kDielectric: {
            const double f0 = normal_reflectance_of(config.refractive_index);
            material.normal_reflectance = grid.average(Curve::constant(f0));
            material.diffuse_albedo = scaled(reflectance, 1 - f0);
            material.specular = f0 > 0;
            break;
        }
        case ReflectionModel::kMirror:
            material.normal_reflectance = reflectance;
            material.ggx_alpha = 0;
            material.specular = true;
            break;
    }
    return material;
}

Material make_material(const MeshSurface& surface, const SpectralGrid& grid) {
    // Three broad bands with 20 nm ramps between them.
    const Curve color{{0.48, 0.50, 0.57, 0.59},
                      {static_cast<double>(surface.base_color.z), static_cast<double>(surface.base_color.y),
                       static_cast<double>(surface.base_color.y), static_cast<double>(surface.base_color.x)}};
    const double metallic = std::clamp(static_cast<double>(surface.metallic), 0.0, 1.0);
    const Spectrum base = grid.average(color);
    // glTF 2.0 specification, appendix B: dielectrics reflect 4 % at normal incidence; metals their base
    // colour.
    constexpr double kDielectricF0 = 0.04;
    Material material;
    material.diffuse_albedo = scaled(base, (1 - metallic) * (1 - kDielectricF0));
    for (int b = 0; b < grid.size(); ++b)
        material.normal_reflectance[b] =
            static_cast<float>((1 - metallic) * kDielectricF0 + metallic * static_cast<double>(base[b]));
    // A file's roughness 0 means "polished"; 0.03 keeps the highlight wider than the Sun's own disk.
    const double roughness = std::clamp(static_cast<double>(surface.roughness), 0.03, 1.0);
    material.ggx_alpha = static_cast<float>(roughness * roughness);
    material.specular = true;
    material.texture = surface.base_color_texture;
    return material;
}

std::vector<Material> make_materials(const Mesh& mesh, std::span<const MaterialConfig> configs,
                                     const SpectralGrid& grid) {
    std::vector<Material> materials;
    for (const MeshSurface& surface : mesh.surfaces) {
        const auto named = std::find_if(configs.begin(), configs.end(), [&](const MaterialConfig& config) {
            return name_matches(config.name, surface.name);
        });
        if (named == configs.end()) {
            materials.push_back(make_material(surface, grid));
        } else {
            materials.push_back(make_material(*named, grid));
            materials.back().texture = surface.base_color_texture;
        }
    }
    return materials;
}

}  // namespace hilcam
