#include "render/scene/material.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "render/scene/material_albedo.h"
#include "render/vocabulary/check.h"

namespace hilcam {

namespace {

// The keys of a model, which change what its material looks like.
template <class Model>
std::vector<std::string> keys_of() {
    std::vector<std::string> keys(Model::kSharedKeys.begin(), Model::kSharedKeys.end());
    typename Model::Keys own;
    for (const Field& field : Model::fields(own)) keys.push_back(field.key);
    if (Model::kTakesTable) keys.emplace_back("table");
    return keys;
}

std::vector<std::string> keys_of(std::size_t model) {
    std::vector<std::string> keys;
    BrdfModels::for_each([&]<class Model>() {
        if (model == kModel<Model>) keys = keys_of<Model>();
    });
    return keys;
}

std::string why_idle(const MaterialConfig& c, const std::string& key) {
    std::vector<std::string> taken = keys_of(c.model);
    taken.insert(taken.end(), {"temperature_k", "source", "model"});
    // Glass has that of its reflection.
    if (c.model != kModel<brdf::Glass>) taken.emplace_back("infrared_emissivity");
    if (std::find(taken.begin(), taken.end(), key) != taken.end()) return {};
    // A surface emits what it does not reflect, whatever its model.
    if (key == "reflectance" && c.temperature_k > 0) return {};
    std::string all;
    for (const std::string& own : taken) all += (all.empty() ? "" : ", ") + own;
    return "has no effect with model " + std::string(BrdfModels::kNames[c.model]) + "; accepted: " + all;
}

}  // namespace

Fields fields(MaterialConfig& c) {
    const Range fraction{0, 1};
    const std::vector<std::string> names(BrdfModels::kNames.begin(), BrdfModels::kNames.end());
    Fields list = {
        text("source", c.source, "source of the data"),
        choice("model", c.model, names, "reflection model; docs/materials.md explains each"),
        curve("reflectance", c.reflectance, fraction,
              "albedo (lambert, oren_nayar, body of a dielectric), reflectance at normal incidence (metal, "
              "mirror), k_d "
              "(phong), I/F (lommel_seeliger), single-scattering albedo (hapke), factor (table); number or "
              "[[um, value], "
              "...]"),
        number("roughness", c.roughness, 1, fraction,
               "roughness. metal, dielectric: the square root of GGX alpha; oren_nayar: standard deviation "
               "of slope over 90 deg"),
        number("refractive_index", c.refractive_index, 1, {1, 4},
               "refractive index of glass or of a dielectric's clear layer"),
    };
    BrdfModels::for_each([&]<class Model>() {
        Fields own = Model::fields(static_cast<typename Model::Keys&>(c));
        std::move(own.begin(), own.end(), std::back_inserter(list));
    });
    list.push_back(number(
        "temperature_k", c.temperature_k, 1, {0, 6000},
        "temperature of the surface for thermal emission, used with radiance: emissive; 0: no emission"));
    list.push_back(optional(
        curve("infrared_emissivity", c.infrared_emissivity, fraction,
              "hemispherical emissivity beyond 2.5 um; left out: 1 - reflectance, if that is a curve "
              "that reaches so far"),
        c.has_infrared_emissivity));
    list.push_back(
        path("table", c.table, "measured BRDF: MERL .binary, or CSV as described in docs/materials.md"));
    for (Field& field : list) field.why_idle = [&c, key = field.key] { return why_idle(c, key); };
    return list;
}

void validate(const MaterialConfig& c) {
    BrdfModels::for_each([&]<class Model>() {
        if (c.model == kModel<Model>) Model::check(c, c);
    });
    if (kBrdfTraits[c.model].takes_table == c.table.empty())
        throw InputError("'table' goes with model table, and only with it");
}

Fields fields(SurfaceConfig& c) {
    return {
        optional(number("temperature_k", c.temperature_k, 1, {0, 6000},
                        "temperature of the surface, in place of its material's"),
                 c.has_temperature),
        required(text("name", c.name, "name of the mesh surface; a trailing * matches any ending")),
        required(section("material", c.material,
                         "material of the surface: a mapping, or a file of configs/materials/")),
    };
}

namespace {

// Makes a material of which only the model's own spectra and the emission are missing.
Material modelled(const MaterialConfig& config, const SpectralGrid& grid,
                  const std::shared_ptr<const BrdfTable>& table, const Spectrum& reflectance) {
    BrdfMaking making{config, grid, table, {0, reflectance, {}}};
    Material m;
    BrdfModels::for_each([&]<class Model>() {
        if (config.model == kModel<Model>) m.brdf = Model(config, making);
    });
    m.base = making.look.base;
    m.highlight = making.look.highlight;
    m.ggx_alpha = making.look.alpha;
    // Glass is opaque beyond 2.5 um, unless its curve says otherwise.
    if (config.model == kModel<brdf::Glass> && config.transmittance.value.size() < 2)
        for (int b = grid.solar_bins(); b < grid.size(); ++b) m.highlight[b] = 0;
    // Phong's two parts keep their proportion.
    if (config.model == kModel<brdf::Phong>)
        for (int b = grid.solar_bins(); b < grid.size(); ++b) m.highlight[b] *= reflectance[b];
    return m;
}

// Finds the reflectance with which the model reflects `wanted` of light from all directions in the thermal
// bins, by bisection in all of them at once: models differ in what their reflectance means.
Material of_emissivity(const MaterialConfig& config, const SpectralGrid& grid,
                       const std::shared_ptr<const BrdfTable>& table, Spectrum reflectance) {
    const Spectrum emissivity = grid.average(config.infrared_emissivity);
    if (config.model == kModel<brdf::Veil> || config.model == kModel<brdf::Lambert>) {
        // Their reflectance is what they reflect: a veil by its threads.
        for (int b = grid.solar_bins(); b < grid.size(); ++b) reflectance[b] = 1 - emissivity[b];
        return modelled(config, grid, table, reflectance);
    }
    Spectrum low, high;
    high.bin.fill(1);
    constexpr int kHalvings = 14;
    for (int i = 0; i < kHalvings; ++i) {
        for (int b = grid.solar_bins(); b < grid.size(); ++b) reflectance[b] = 0.5f * (low[b] + high[b]);
        const MaterialAlbedo albedo(modelled(config, grid, table, reflectance), MaterialAlbedo::kExact);
        for (int b = grid.solar_bins(); b < grid.size(); ++b)
            (albedo.white_lobe()[b] + albedo.white_base()[b] < 1 - emissivity[b] ? low : high)[b] =
                reflectance[b];
    }
    return modelled(config, grid, table, reflectance);
}

// True when the reflectance says itself what the thermal bins reflect.
bool reflectance_reaches(const MaterialConfig& config, const SpectralGrid& grid) {
    const std::vector<double>& um = config.reflectance.wavelength_um;
    return um.size() >= 2 && um.back() >= grid.to_um(grid.size() - 1);
}

}  // namespace

Material make_material(const MaterialConfig& config, const SpectralGrid& grid,
                       std::shared_ptr<const BrdfTable> table) {
    require_solar_cover(config.reflectance, grid, "reflectance");
    const Spectrum reflectance = grid.average(config.reflectance);
    const bool has_emissivity = config.has_infrared_emissivity;
    if (grid.has_thermal() && !has_emissivity && !reflectance_reaches(config, grid) &&
        config.model != kModel<brdf::Glass>)
        throw InputError(
            "infrared_emissivity: not given, and spectrum_edges_um reach beyond 2.5 um; accepted: a number, "
            "a "
            "curve, or a reflectance by wavelength that reaches as far");
    const bool fits = grid.has_thermal() && has_emissivity && config.model != kModel<brdf::Glass>;
    Material m =
        fits ? of_emissivity(config, grid, table, reflectance) : modelled(config, grid, table, reflectance);
    set_temperature(m, grid, config.temperature_k);
    return m;
}

void set_temperature(Material& material, const SpectralGrid& grid, double temperature_k) {
    material.emission = ThermalEmission(material, grid, temperature_k);
}

namespace {

Material clear_sheet(const MeshSurface& surface, const SpectralGrid& grid) {
    MaterialConfig sheet;
    sheet.model = kModel<brdf::Glass>;
    sheet.refractive_index = static_cast<double>(surface.refractive_index);
    sheet.transmittance = Curve::constant(static_cast<double>(surface.transmission));
    return make_material(sheet, grid);
}

// Three broad bands with 20 nm ramps between them.
Curve color_of(const MeshSurface& surface) {
    const double red = static_cast<double>(surface.base_color.x),
                 green = static_cast<double>(surface.base_color.y),
                 blue = static_cast<double>(surface.base_color.z);
    return {
        {kShortest_um, 0.48, 0.50, 0.57, 0.59, kThermalFrom_um}, {blue, blue, green, green, red, red}, {}};
}

Material veil_of(const MeshSurface& surface, const Curve& color, const SpectralGrid& grid) {
    MaterialConfig veil;
    veil.model = kModel<brdf::Veil>;
    veil.reflectance = Curve::constant(1);
    veil.cover = static_cast<double>(surface.opacity);
    veil.infrared_emissivity = Curve::constant(kUnknownEmissivity);
    veil.has_infrared_emissivity = true;
    Material out = make_material(veil, grid);
    const Spectrum colors = grid.average(color);
    for (int b = 0; b < grid.solar_bins(); ++b) out.base[b] *= colors[b];
    out.texture = surface.base_color_texture;
    return out;
}

// The same look as a material of a file, which has an emissivity.
Material thermal_look(const MeshSurface& surface, const Curve& color, const SpectralGrid& grid) {
    const bool is_metal = surface.metallic >= 0.5f;
    MaterialConfig look;
    look.model = is_metal ? kModel<brdf::Metal> : kModel<brdf::Dielectric>;
    look.reflectance = color;
    look.roughness = static_cast<double>(std::clamp(surface.roughness, 0.03f, 1.0f));
    look.refractive_index = static_cast<double>(surface.refractive_index);
    look.infrared_emissivity = Curve::constant(is_metal ? kUnknownMetalEmissivity : kUnknownEmissivity);
    look.has_infrared_emissivity = true;
    Material out = make_material(look, grid);
    out.texture = surface.base_color_texture;
    return out;
}

}  // namespace

Material make_material(const MeshSurface& surface, const SpectralGrid& grid) {
    if (surface.transmission >= 0.5f) return clear_sheet(surface, grid);
    const Curve color = color_of(surface);
    if (surface.opacity < 1) return veil_of(surface, color, grid);
    if (grid.has_thermal()) return thermal_look(surface, color, grid);
    // glTF 2.0, appendix B, blends both looks. Here the larger share decides, and a half metal becomes a
    // darker one.
    const float metallic = std::clamp(surface.metallic, 0.0f, 1.0f);
    // A file's roughness 0 means "polished"; 0.03 keeps the highlight wider than the Sun's own disk.
    const float roughness = std::clamp(surface.roughness, 0.03f, 1.0f);
    Material m;
    m.ggx_alpha = roughness * roughness;
    m.texture = surface.base_color_texture;
    if (metallic >= 0.5f) {
        const brdf::Metal metal(m.ggx_alpha);
        m.highlight = grid.average(color);
        m.base = metal.multiple_facets(m.highlight, grid.size());
        m.brdf = metal;
        return m;
    }
    const brdf::Dielectric dielectric(m.ggx_alpha, surface.refractive_index);
    m.highlight = dielectric.normal_incidence();
    m.brdf = dielectric;
    m.base = grid.average(color);
    return m;
}

const SurfaceConfig* find_surface(std::span<const SurfaceConfig> configs, const std::string& name) {
    const auto matches = [&](const SurfaceConfig& config) {
        const std::string& pattern = config.name;
        if (!pattern.empty() && pattern.back() == '*')
            return name.starts_with(pattern.substr(0, pattern.size() - 1));
        return pattern == name;
    };
    const auto found = std::find_if(configs.begin(), configs.end(), matches);
    return found == configs.end() ? nullptr : &*found;
}

}  // namespace hilcam
