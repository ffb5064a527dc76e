#include "render/scene/brdf.h"

#include <algorithm>
#include <cmath>

#include "render/scene/brdf_diffuse.h"
#include "render/scene/brdf_microfacet.h"
#include "render/scene/brdf_table.h"
#include "render/sky/regolith.h"
#include "render/vocabulary/clones.h"
#include "render/vocabulary/lane_sum.h"

namespace hilcam {
namespace {

using Model = ReflectionModel;

// Fresnel reflectance per bin of a facet met at this cosine.
Spectrum fresnel(const Scatterer& at, float cosine) {
    Spectrum out;
    if (at.material->model == Model::kDielectric) {
        out.bin.fill(fresnel_dielectric(at.material->refractive_index, cosine));
        return out;
    }
    const float schlick = schlick_weight(cosine);
    for (int b = 0; b < kMaxBins; ++b) out[b] = at.highlight[b] + (1 - at.highlight[b]) * schlick;
    return out;
}

// A thin sheet, light that bounces inside it included, for the bins of its inner transmittance: Born &
// Wolf, 7.6.1, intensities added.
struct Sheet {
    Spectrum reflected, passed;
};
Sheet sheet(const Scatterer& at, float cosine) {
    const float n = at.material->refractive_index;
    const float f = fresnel_dielectric(n, cosine);
    // The path inside is longer by the refracted angle (Snell).
    const float inside = std::sqrt(std::max(1e-6f, 1 - (1 - cosine * cosine) / (n * n)));
    Sheet out;
    for (int b = 0; b < kMaxBins; ++b) {
        const float t = at.highlight[b] > 0 ? std::pow(at.highlight[b], 1 / inside) : 0.0f;
        const float below = 1 - f * f * t * t;
        out.passed[b] = (1 - f) * (1 - f) * t / below;
        out.reflected[b] = f + f * (1 - f) * (1 - f) * t * t / below;
    }
    return out;
}

struct HalfVector {
    float nh, ih;
};
HalfVector half_vector(Cosines c) {
    const float length_squared = std::max(2 + 2 * c.io, 1e-8f);
    return {std::clamp((c.no + c.ni) / std::sqrt(length_squared), 0.0f, 1.0f),
            0.5f * std::sqrt(length_squared)};
}

// (1-E(no))(1-E(ni)) / (pi (1-E_avg)): light that entered below the facets' single reflection.
float below_facets(const LobeAlbedo& e, float no, float ni) {
    return e.average < 0.9999f ? (1 - e(no)) * (1 - e(ni)) / (kPiF * (1 - e.average)) : 0.0f;
}

// The chance that a sample takes the highlight.
float highlight_chance(const Scatterer& at, float no) {
    const Material& m = *at.material;
    switch (m.model) {
        case Model::kMetal:
        case Model::kDielectric: {
            const float top = (m.model == Model::kMetal ? largest(at.highlight) : 1.0f) * m.facets(no);
            const float below = largest(at.base) * (1 - m.facets(no));
            return top + below > 0 ? top / (top + below) : 1.0f;
        }
        case Model::kPhong: {
            const float top = largest(at.highlight), below = largest(at.base);
            return top + below > 0 ? top / (top + below) : 0.0f;
        }
        case Model::kTable:
            return m.table->lobe_share();
        case Model::kMirror:
        case Model::kGlass:
            return 1;
        default:
            return 0;
    }
}

// Density of the highlight's own sampler.
float highlight_density(const Scatterer& at, Cosines c) {
    const Material& m = *at.material;
    if (m.model == Model::kPhong) return phong_density(m.exponent, c.no, c.ni, c.io);
    const float alpha = m.model == Model::kTable ? m.table->lobe_alpha() : at.alpha;
    return alpha > 0 ? ggx_density(alpha, c.no, half_vector(c).nh) : 0.0f;
}

}  // namespace

Spectrum brdf_value(const Scatterer& at, Cosines c) {
    if (!(c.no > 0 && c.ni > 0)) return {};
    const Material& m = *at.material;
    switch (m.model) {
        case Model::kLambert:
            return (1 / kPiF) * at.base;
        case Model::kMirror:
        case Model::kMetal:
        case Model::kDielectric: {
            Spectrum f = below_facets(m.facets, c.no, c.ni) * at.base;
            if (at.alpha > 0) {
                const HalfVector h = half_vector(c);
                f += ggx_distribution(at.alpha, h.nh) * ggx_visibility(at.alpha, c.no, c.ni) *
                     fresnel(at, h.ih);
            }
            return f;
        }
        case Model::kOrenNayar: {
            const OrenNayar model(m.roughness);
            const float single = model.single(c.no, c.ni, c.io), multiple = model.multiple(c.no, c.ni);
            Spectrum f;
            for (int b = 0; b < kMaxBins; ++b)
                f[b] = single * at.base[b] + multiple * model.multiple_color(at.base[b]);
            return f;
        }
        case Model::kPhong:
            return phong_lobe(m.exponent, c.no, c.ni, c.io) * at.highlight + (1 / kPiF) * at.base;
        case Model::kLommelSeeliger:
            return lommel_seeliger(c.no, c.ni) * at.base;
        case Model::kHapke: {
            const HapkeGeometry g = hapke_geometry(m.hapke, c.no, c.ni, c.io);
            Spectrum f;
            for (int b = 0; b < kMaxBins; ++b) f[b] = hapke(g, at.base[b]);
            return f;
        }
        case Model::kTable:
            return at.base * m.table->value(c.no, c.ni, c.io);
        case Model::kGlass:
            return {};
    }
    return {};
}

namespace {

// weight times below_facets(), and times D V of a lobe.
HILCAM_CLONES void reflect_below(const BrdfSum::Lanes& weight, const BrdfSum::Lanes& no,
                                 const BrdfSum::Lanes& ni, const LobeAlbedo& e, BrdfSum::Lanes& out) {
    for (std::size_t i = 0; i < weight.size(); ++i) out[i] = weight[i] * below_facets(e, no[i], ni[i]);
}
HILCAM_CLONES void reflect_lobe(const BrdfSum::Lanes& weight, const BrdfSum::Lanes& no,
                                const BrdfSum::Lanes& ni, const BrdfSum::Lanes& rougher, float alpha,
                                float over_half, BrdfSum::Lanes& out) {
    for (std::size_t i = 0; i < weight.size(); ++i) {
        const float nh = std::min((no[i] + ni[i]) * over_half, 1.0f);
        // Slopes s of density a^2 / (pi (a^2 + s^2)^2) (GGX's: Heitz, JCGT 3(2), 2014) that are scattered by
        // r: to the first order the density changes by r (4 s^2 - 2 a^2) / (a^2 + s^2)^2 of itself. A lobe
        // whose a^2 grows by 4 r a^2 / (2 a^2 + s^2) does so at its middle and in its tails, which hardly
        // change.
        const float both = alpha * alpha + rougher[i], slope = (1 - nh * nh) / (nh * nh);
        const float wider =
            std::min(std::sqrt(alpha * alpha + rougher[i] * 4 * both / (2 * both + slope)), 1.0f);
        const float lobe = ggx_distribution(wider, nh) * ggx_visibility(wider, no[i], std::max(ni[i], 1e-6f));
        out[i] = weight[i] * lobe;
    }
}

}  // namespace

void BrdfSum::add(const Lanes& weight, const Lanes& no, const Lanes& ni, const Lanes& rougher) {
    const Material& m = *at_.material;
    if (m.model == Model::kLambert) {
        below_ += lane_sum(weight) / kPiF;
        return;
    }
    if (!m.has_facets()) {
        for (std::size_t i = 0; i < weight.size(); ++i)
            if (weight[i] > 0) other_ += weight[i] * brdf_value(at_, {no[i], ni[i], io_});
        return;
    }
    Lanes part;
    reflect_below(weight, no, ni, m.facets, part);
    below_ += lane_sum(part);
    if (!(at_.alpha > 0)) return;
    reflect_lobe(weight, no, ni, rougher, at_.alpha, 1 / std::sqrt(std::max(2 + 2 * io_, 1e-8f)), part);
    lobe_ += lane_sum(part);
}

Spectrum BrdfSum::value() const {
    Spectrum f = other_ + below_ * at_.base;
    // The facets' reflection depends on the angle between viewer and light alone.
    if (lobe_ > 0) f += lobe_ * fresnel(at_, half_vector({1, 1, io_}).ih);
    return f;
}

float brdf_density(const Scatterer& at, Cosines c) {
    if (!(c.no > 0 && c.ni > 0) || !at.has_lobes()) return 0;
    const float top = highlight_chance(at, c.no);
    const float diffuse = (1 - top) * c.ni / kPiF;
    return top > 0 ? diffuse + top * highlight_density(at, c) : diffuse;
}

BrdfSample brdf_exact(const Scatterer& at, Vec3f normal, Vec3f view_dir, int part) {
    BrdfSample out;
    const Material& m = *at.material;
    const float no = std::clamp(dot(normal, view_dir), 1e-4f, 1.0f);
    if (part == 0 && at.has_exact()) {
        out.dir = normalized(reflect(view_dir, normal));
        out.weight = m.model == Model::kGlass ? sheet(at, no).reflected : fresnel(at, no);
        out.exact = out.valid = true;
    }
    if (part == 1 && at.is_glass()) {
        out.dir = -view_dir;
        out.weight = sheet(at, no).passed;
        out.exact = out.valid = out.transmits = true;
    }
    return out;
}

BrdfSample brdf_sample(const Scatterer& at, Vec3f normal, Vec3f view_dir, std::array<float, 3> u) {
    const Material& m = *at.material;
    const float no = std::max(dot(normal, view_dir), 1e-4f);
    const float top = highlight_chance(at, no);
    const bool highlight = u[0] < top;
    BrdfSample out;
    if (at.is_glass()) {
        const Sheet both = sheet(at, no);
        const float chance = largest(both.reflected) / (largest(both.reflected) + largest(both.passed));
        const int part = u[1] < chance ? 0 : 1;
        out = brdf_exact(at, normal, view_dir, part);
        out.weight = (1 / (part == 0 ? chance : 1 - chance)) * out.weight;
        return out;
    }
    if (highlight && at.has_exact()) {
        out = brdf_exact(at, normal, view_dir, 0);
        out.weight = (1 / top) * out.weight;
        return out;
    }
    const Frame local(normal);
    if (!highlight) {
        out.dir = local.to_world(sample_cosine(u[1], u[2]));
        out.diffuse = true;
    } else if (m.model == Model::kPhong) {
        // About the mirror direction: cos^n (Lafortune & Willems 1994, eq. 10).
        const float z = std::pow(u[1], 1 / (m.exponent + 1));
        const float r = std::sqrt(std::max(0.0f, 1 - z * z)), phi = 2 * kPiF * u[2];
        out.dir =
            Frame(normalized(reflect(view_dir, normal))).to_world({r * std::cos(phi), r * std::sin(phi), z});
    } else {
        const float alpha = m.model == Model::kTable ? m.table->lobe_alpha() : at.alpha;
        const Vec3f facet =
            local.to_world(sample_visible_normal(alpha, local.to_local(view_dir), u[1], u[2]));
        out.dir = normalized(reflect(view_dir, facet));
    }
    const Cosines c{no, dot(normal, out.dir), dot(view_dir, out.dir)};
    out.density = brdf_density(at, c);
    out.valid = c.ni > 0 && out.density > 0;
    if (out.valid) out.weight = (c.ni / out.density) * brdf_value(at, c);
    return out;
}

Spectrum sheet_transmittance(const Scatterer& at, float cosine) {
    if (!at.is_glass()) return {};
    return sheet(at, std::clamp(cosine, 1e-4f, 1.0f)).passed;
}

float brdf_albedo(const Scatterer& at, float no, int bins) {
    const Material& m = *at.material;
    const float base = mean(at.base, bins), highlight = mean(at.highlight, bins);
    switch (m.model) {
        case Model::kMetal:
            return highlight * m.facets(no) + base * (1 - m.facets(no));
        case Model::kDielectric:
            return m.facets(no) + base * (1 - m.facets(no));
        case Model::kMirror:
            return highlight;
        case Model::kGlass:
            return 1;
        case Model::kPhong:
            return base + highlight;
        default:
            return base;
    }
}

}  // namespace hilcam
