#include "render/scene/material.h"

#include <algorithm>
#include <cmath>

#include "render/scene/brdf_microfacet.h"
#include "render/scene/brdf_table.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

using Model = ReflectionModel;

// Colour of the light that met several facets of a metal: F_avg^2 E_avg / (1 - F_avg (1 - E_avg)) with
// F_avg = (20 F0 + 1) / 21 of Schlick's term (Kulla & Conty 2017).
Spectrum multiple_facets(const Spectrum& normal_reflectance, float e_average, int bins) {
    Spectrum out;
    for (int b = 0; b < bins; ++b) {
        const float f = (20 * normal_reflectance[b] + 1) / 21;
        out[b] = f * f * e_average / (1 - f * (1 - e_average));
    }
    return out;
}

// Mean albedo of one reflection at a facet lobe; the facet's Fresnel term or 1.
float lobe_albedo(float alpha, float refractive_index, float cosine) {
    const auto fresnel = [&](float c) {
        return refractive_index > 0 ? fresnel_dielectric(refractive_index, c) : 1.0f;
    };
    if (alpha == 0) return fresnel(cosine);
    const float no = std::max(cosine, 1e-3f);
    const Vec3f view{std::sqrt(std::max(0.0f, 1 - no * no)), 0, no};
    constexpr int kGrid = 48;
    double sum = 0;
    for (int i = 0; i < kGrid; ++i) {
        // Crowded where facets are steep (u near 1): few, but what they lose is all that is lost.
        const float left = 1 - (static_cast<float>(i) + 0.5f) / kGrid;
        const float u1 = 1 - left * left * left;
        double ring = 0;
        for (int j = 0; j < kGrid; ++j) {
            const Vec3f facet =
                sample_visible_normal(alpha, view, u1, (static_cast<float>(j) + 0.5f) / kGrid);
            const float ni = reflect(view, facet).z;
            if (ni > 0)
                ring += static_cast<double>(fresnel(dot(view, facet)) * ggx_sample_weight(alpha, no, ni));
        }
        sum += 3 * static_cast<double>(left * left) * ring;
    }
    return static_cast<float>(sum / (kGrid * kGrid));
}

}  // namespace

Fields fields(MaterialConfig& c) {
    const Range fraction{0, 1};
    return {
        text("source", c.source, "source of the figures"),
        choice("model", c.model,
               {"lambert", "metal", "dielectric", "mirror", "glass", "oren_nayar", "phong", "lommel_seeliger",
                "hapke", "table"},
               "reflection model; docs/materials.md explains each"),
        curve("reflectance", c.reflectance, fraction,
              "albedo (lambert, oren_nayar, body of a dielectric), reflectance at normal incidence (metal, "
              "mirror), k_d "
              "(phong), I/F (lommel_seeliger), single-scattering albedo (hapke), factor (table); number or "
              "[[um, value], "
              "...]"),
        number(
            "roughness", c.roughness, 1, fraction,
            "roughness. metal, dielectric: GGX alpha is its square; oren_nayar: slope deviation over 90 deg"),
        number("refractive_index", c.refractive_index, 1, {1, 4},
               "refractive index of glass or of a dielectric's clear layer"),
        curve("transmittance", c.transmittance, fraction,
              "transmittance inside a glass sheet, at normal incidence"),
        curve("specular", c.specular, fraction, "k_s of phong"),
        number("exponent", c.exponent, 1, {0, 1e5}, "n of phong"),
        number("lobe_width", c.lobe_width, 1, {0, 0.95}, "b of hapke"),
        number("lobe_backward", c.lobe_backward, 1, {-1, 1},
               "c of hapke: (1+c)/2 of the light goes backward"),
        number("surge_amplitude", c.surge_amplitude, 1, {0, 10}, "B0 of hapke: opposition surge"),
        number("surge_width", c.surge_width, 1, {1e-4, 1}, "h of hapke: its width"),
        number("slope_deg", c.slope_rad, kDegree_rad, {0, 60},
               "theta-bar of hapke: mean slope of the surface"),
        number("temperature_k", c.temperature_k, 1, {0, 6000},
               "temperature for the surface's thermal emission, used with radiance: emissive; 0: none"),
        path("table", c.table, "a measured BRDF: MERL .binary, or CSV as docs/materials.md describes"),
    };
}

void validate(const MaterialConfig& c) {
    const auto most = [](const Curve& curve) {
        return *std::max_element(curve.value.begin(), curve.value.end());
    };
    if (c.model == Model::kPhong && most(c.reflectance) + most(c.specular) > 1)
        throw InputError("reflectance and specular: found a sum of " +
                         std::to_string(most(c.reflectance) + most(c.specular)) +
                         "; accepted with model phong: 0 to 1 (above, light would be created)");
    // w/2 (1 - mu ln(1 + 1/mu)) is at most w/2 = 4 I/F.
    if (c.model == Model::kLommelSeeliger && most(c.reflectance) > 0.25)
        throw InputError(
            "reflectance: found " + std::to_string(most(c.reflectance)) +
            "; accepted with model lommel_seeliger: 0 to 0.25 (above, grazing light would be created)");
    if ((c.model == Model::kTable) == c.table.empty())
        throw InputError(c.table.empty() ? "table: found none; accepted: a file, as the model is table"
                                         : "table: found a file; accepted: none, as the model is not table");
}

Fields fields(SurfaceConfig& c) {
    return {
        required(text("name", c.name,
                      "name of the mesh's surface that is covered; a trailing * matches any ending")),
        required(section("material", c.material,
                         "material of the surface: a mapping, or a file of configs/materials/")),
    };
}

LobeAlbedo ggx_albedo(float alpha, float refractive_index) {
    LobeAlbedo out;
    constexpr int n = LobeAlbedo::kSteps;
    for (int i = 0; i <= n; ++i)
        out.at_cosine[static_cast<std::size_t>(i)] =
            lobe_albedo(alpha, refractive_index, static_cast<float>(i) / static_cast<float>(n));
    // 2 int E mu dmu, exact for the straight pieces that operator() uses.
    double sum = 0;
    for (int i = 0; i < n; ++i) {
        const double a = static_cast<double>(i) / n, b = static_cast<double>(i + 1) / n;
        const auto ea = static_cast<double>(out.at_cosine[static_cast<std::size_t>(i)]);
        const auto eb = static_cast<double>(out.at_cosine[static_cast<std::size_t>(i) + 1]);
        sum += (b - a) * (ea * (2 * a + b) + eb * (a + 2 * b)) / 3;
    }
    out.average = static_cast<float>(sum);
    return out;
}

Material make_material(const MaterialConfig& config, const SpectralGrid& grid,
                       std::shared_ptr<const BrdfTable> table) {
    require_cover(config.reflectance, grid, "reflectance");
    Material m;
    m.model = config.model;
    const Spectrum reflectance = grid.average(config.reflectance);
    const auto alpha = static_cast<float>(config.roughness * config.roughness);
    m.base = reflectance;
    switch (config.model) {
        case Model::kLambert:
            break;
        case Model::kOrenNayar:
            m.roughness = static_cast<float>(config.roughness);
            break;
        case Model::kMetal:
            m.highlight = reflectance;
            m.ggx_alpha = alpha;
            m.facets = ggx_albedo(alpha, 0);
            m.base = multiple_facets(reflectance, m.facets.average, grid.size());
            break;
        case Model::kDielectric:
            m.refractive_index = static_cast<float>(config.refractive_index);
            m.ggx_alpha = alpha;
            m.facets = ggx_albedo(alpha, m.refractive_index);
            break;
        case Model::kMirror:
            m.base = {};
            m.highlight = reflectance;
            break;
        case Model::kGlass:
            require_cover(config.transmittance, grid, "transmittance");
            m.base = {};
            m.highlight = grid.average(config.transmittance);
            m.refractive_index = static_cast<float>(config.refractive_index);
            break;
        case Model::kPhong:
            require_cover(config.specular, grid, "specular");
            m.highlight = grid.average(config.specular);
            m.exponent = static_cast<float>(config.exponent);
            break;
        case Model::kLommelSeeliger:
            // f = w/4pi / (no + ni) gives I/F = w/8 at no = ni = 1.
            for (float& w : m.base.bin) w *= 8;
            break;
        case Model::kHapke:
            m.hapke = {static_cast<float>(config.lobe_width), static_cast<float>(config.lobe_backward),
                       static_cast<float>(config.surge_amplitude), static_cast<float>(config.surge_width),
                       static_cast<float>(std::tan(config.slope_rad))};
            break;
        case Model::kTable:
            HILCAM_CHECK(table != nullptr);
            m.table = std::move(table);
            break;
    }
    if (config.temperature_k > 0)
        for (int b = 0; b < grid.size(); ++b)
            m.emission[b] = static_cast<float>(1 - static_cast<double>(reflectance[b])) *
                            static_cast<float>(planck_w_m2_sr_um(grid.center_um(b), config.temperature_k));
    return m;
}

Material make_material(const MeshSurface& surface, const SpectralGrid& grid) {
    // Three broad bands with 20 nm ramps between them.
    const Curve color{{0.48, 0.50, 0.57, 0.59},
                      {static_cast<double>(surface.base_color.z), static_cast<double>(surface.base_color.y),
                       static_cast<double>(surface.base_color.y), static_cast<double>(surface.base_color.x)},
                      {}};
    // glTF 2.0, appendix B, blends both looks; here the greater share decides, and a half metal is a darker
    // one.
    const float metallic = std::clamp(surface.metallic, 0.0f, 1.0f);
    // A file's roughness 0 means "polished"; 0.03 keeps the highlight wider than the Sun's own disk.
    const float roughness = std::clamp(surface.roughness, 0.03f, 1.0f);
    Material m;
    m.ggx_alpha = roughness * roughness;
    m.texture = surface.base_color_texture;
    if (metallic >= 0.5f) {
        m.model = Model::kMetal;
        m.facets = ggx_albedo(m.ggx_alpha, 0);
        m.highlight = grid.average(color);
        m.base = multiple_facets(m.highlight, m.facets.average, grid.size());
        return m;
    }
    // Dielectrics reflect 4 % at normal incidence there: refractive index 1.5.
    m.model = Model::kDielectric;
    m.refractive_index = 1.5f;
    m.facets = ggx_albedo(m.ggx_alpha, m.refractive_index);
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
