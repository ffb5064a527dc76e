#include "render/scene/brdf.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {

Spectrum brdf_value(const Bsdf& at, Cosines c) {
    if (!(c.no > 0 && c.ni > 0)) return {};
    return std::visit([&](const auto& model) { return model.value(at, c); }, at.material->brdf);
}

const LobeAlbedo* facets_of(const Material& material) {
    return std::visit(
        []<class Model>(const Model& model) -> const LobeAlbedo* {
            if constexpr (Model::kHasFacets)
                return &model.facets;
            else
                return nullptr;
        },
        material.brdf);
}

namespace {

// top: probability of a highlight sample in this model.
template <class Model>
float density_of(const Model& model, const Bsdf& at, Cosines c, float top) {
    const float diffuse = (1 - top) * c.ni / kPiF;
    return top > 0 ? diffuse + top * model.highlight_density(at, c) : diffuse;
}

}  // namespace

float brdf_density(const Bsdf& at, Cosines c) {
    if (!(c.no > 0 && c.ni > 0) || !at.has_lobes()) return 0;
    if (at.is_glass()) return 0;
    return std::visit(
        [&](const auto& model) { return density_of(model, at, c, model.highlight_chance(at, c.no)); },
        at.material->brdf);
}

BrdfSample brdf_exact(const Bsdf& at, Vec3f normal, Vec3f view_dir, int part) {
    BrdfSample out;
    const float no = std::clamp(dot(normal, view_dir), 1e-4f, 1.0f);
    if (part == 0 && at.has_exact()) {
        out.dir = normalized(reflect(view_dir, normal));
        out.weight = brdf_mirrored(at, no);
        out.exact = out.valid = true;
    }
    if (part == 1 && at.is_glass()) {
        out.dir = -view_dir;
        out.weight = sheet_transmittance(at, no);
        out.exact = out.valid = out.transmits = true;
    }
    return out;
}

namespace {

BrdfSample sample_sheet(const Bsdf& at, Vec3f normal, Vec3f view_dir, float u) {
    const float no = std::max(dot(normal, view_dir), 1e-4f);
    const float chance = std::visit(
        [&](const auto& model) {
            const float back = max_component(model.mirrored(at, no)),
                        through = max_component(model.passed(at, no));
            return back > 0 ? back / (back + through) : 0.0f;
        },
        at.material->brdf);
    const int part = u < chance ? 0 : 1;
    BrdfSample out = brdf_exact(at, normal, view_dir, part);
    out.weight = (1 / (part == 0 ? chance : 1 - chance)) * out.weight;
    return out;
}

}  // namespace

BrdfSample brdf_sample(const Bsdf& at, Vec3f normal, Vec3f view_dir, std::array<float, 3> u) {
    if (at.is_glass()) return sample_sheet(at, normal, view_dir, u[1]);
    const float no = std::max(dot(normal, view_dir), 1e-4f);
    return std::visit(
        [&](const auto& model) {
            const float top = model.highlight_chance(at, no);
            const bool highlight = u[0] < top;
            BrdfSample out;
            if (highlight && at.has_exact()) {
                out = brdf_exact(at, normal, view_dir, 0);
                out.weight = (1 / top) * out.weight;
                return out;
            }
            const Frame local(normal);
            if (highlight) {
                out.dir = model.sample_highlight(at, local, view_dir, u[1], u[2]);
            } else {
                out.dir = local.to_world(sample_cosine(u[1], u[2]));
                out.diffuse = true;
            }
            const Cosines c{no, dot(normal, out.dir), dot(view_dir, out.dir)};
            if (c.ni > 0 && at.has_lobes()) out.density = density_of(model, at, c, top);
            out.valid = out.density > 0;
            if (out.valid) out.weight = (c.ni / out.density) * brdf_value(at, c);
            return out;
        },
        at.material->brdf);
}

Spectrum sheet_transmittance(const Bsdf& at, float cosine) {
    const float c = std::clamp(cosine, 1e-4f, 1.0f);
    return std::visit([&](const auto& model) { return model.passed(at, c); }, at.material->brdf);
}

float brdf_albedo(const Bsdf& at, float no, int bins) {
    return std::visit([&](const auto& model) { return model.albedo(at, no, bins); }, at.material->brdf);
}

Spectrum brdf_mirrored(const Bsdf& at, float cosine) {
    return std::visit([&](const auto& model) { return model.mirrored(at, cosine); }, at.material->brdf);
}

Spectrum brdf_diffuse_value(const Bsdf& at, Cosines c) {
    const LobeAlbedo* const facets = facets_of(*at.material);
    return facets ? below_facets(*facets, c.no, c.ni) * at.base : brdf_value(at, c);
}

float brdf_below_facets(const Material& material, float no) {
    const LobeAlbedo* const facets = facets_of(material);
    return facets ? 1 - (*facets)(no) : 1.0f;
}

namespace {

// Returns the share of sunlight from 45 degrees that is reflected in all directions: the midpoint rule over
// the hemisphere, for models without narrow lobes.
double hemispherical_reflectance(const Bsdf& at, const SpectralGrid& grid) {
    constexpr int kCosines = 32, kAzimuths = 64;
    constexpr float in = 0.70710678f;
    double sum = 0;
    for (int i = 0; i < kCosines; ++i)
        for (int j = 0; j < kAzimuths; ++j) {
            const float out = (static_cast<float>(i) + 0.5f) / kCosines;
            const float azimuth_rad = 2 * kPiF * (static_cast<float>(j) + 0.5f) / kAzimuths;
            const float between =
                in * out + std::sqrt((1 - in * in) * (1 - out * out)) * std::cos(azimuth_rad);
            sum += static_cast<double>(mean(brdf_value(at, {in, out, between}), grid.size()) * out);
        }
    return sum * 2 * kPi / (kCosines * kAzimuths);
}

}  // namespace

// brdf_albedo(), which serves paths, is far above what these models reflect.
double reflectance_of(const Material& material, const SpectralGrid& grid) {
    const Bsdf at{&material, material.ggx_alpha, material.base, material.highlight};
    constexpr float kCosine = 0.7f;
    return std::min(1.0, material.traits().albedo_is_bound
                             ? hemispherical_reflectance(at, grid)
                             : static_cast<double>(brdf_albedo(at, kCosine, grid.size())));
}

}  // namespace hilcam
