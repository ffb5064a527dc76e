#pragma once
// model: dielectric. A diffuse body under a clear layer of GGX facets with the exact Fresnel term; light that
// enters the body leaves it again by its albedo (facet_lobe.h). `reflectance` is the body's albedo,
// `roughness` the square root of the GGX alpha, `refractive_index` that of the layer.

#include "render/brdf/facet_lobe.h"

namespace hilcam::brdf {

struct Dielectric : FacetModel<Dielectric> {
    static constexpr std::string_view kName = "dielectric";
    static constexpr std::array<std::string_view, 3> kSharedKeys{"reflectance", "roughness",
                                                                 "refractive_index"};

    float refractive_index;

    Dielectric(float alpha, float index) : refractive_index(index) { facets = ggx_albedo(alpha, index); }
    Dielectric(const Keys&, BrdfMaking& m)
        : Dielectric(static_cast<float>(m.keys.roughness * m.keys.roughness),
                     static_cast<float>(m.keys.refractive_index)) {
        m.look.alpha = static_cast<float>(m.keys.roughness * m.keys.roughness);
        m.look.highlight = normal_incidence();
    }

    // Returns the layer's reflectance at normal incidence.
    Spectrum normal_incidence() const {
        const float r = (refractive_index - 1) / (refractive_index + 1);
        Spectrum out;
        out.bin.fill(r * r);
        return out;
    }

    Spectrum mirrored(const BsdfInputs&, float cosine) const {
        Spectrum out;
        out.bin.fill(fresnel_dielectric(refractive_index, cosine));
        return out;
    }
    float highlight_chance(const BsdfInputs& at, float no) const {
        const float top = 1.0f * facets(no), below = max_component(at.base) * (1 - facets(no));
        return top + below > 0 ? top / (top + below) : 1.0f;
    }
    float albedo(const BsdfInputs& at, float no, int bins) const {
        return facets(no) + mean(at.base, bins) * (1 - facets(no));
    }
};

}  // namespace hilcam::brdf
