#pragma once
// model: metal. GGX facets with Schlick's Fresnel term (microfacet.h), plus light that met several facets
// (facet_lobe.h). `reflectance` is that at normal incidence, `roughness` the square root of the GGX alpha.

#include "render/brdf/facet_lobe.h"

namespace hilcam::brdf {

struct Metal : FacetModel<Metal> {
    static constexpr std::string_view kName = "metal";
    static constexpr std::array<std::string_view, 2> kSharedKeys{"reflectance", "roughness"};
    static constexpr bool kHasBody = false;

    explicit Metal(float alpha) { facets = ggx_albedo(alpha, 0); }
    Metal(const Keys&, BrdfMaking& m) : Metal(static_cast<float>(m.keys.roughness * m.keys.roughness)) {
        m.look = {static_cast<float>(m.keys.roughness * m.keys.roughness),
                  multiple_facets(m.look.base, m.grid.size()), m.look.base};
    }

    // Returns the colour of light that met several facets: F_avg^2 E_avg / (1 - F_avg (1 - E_avg)) with F_avg
    // = (20 F0 + 1) / 21 for Schlick's term (Kulla & Conty 2017).
    Spectrum multiple_facets(const Spectrum& normal_reflectance, int bins) const {
        Spectrum out;
        for (int b = 0; b < bins; ++b) {
            const float f = (20 * normal_reflectance[b] + 1) / 21;
            out[b] = f * f * facets.average / (1 - f * (1 - facets.average));
        }
        return out;
    }

    Spectrum mirrored(const BsdfInputs& at, float cosine) const { return schlick(at.highlight, cosine); }
    float highlight_chance(const BsdfInputs& at, float no) const {
        const float top = max_component(at.highlight) * facets(no),
                    below = max_component(at.base) * (1 - facets(no));
        return top + below > 0 ? top / (top + below) : 1.0f;
    }
    float albedo(const BsdfInputs& at, float no, int bins) const {
        return mean(at.highlight, bins) * facets(no) + mean(at.base, bins) * (1 - facets(no));
    }
};

}  // namespace hilcam::brdf
