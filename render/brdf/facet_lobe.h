#pragma once
// The total light that a lobe of GGX facets reflects, and the common base of models with such a lobe.
//
// metal and dielectric conserve energy. Light that leaves the facets after several reflections (metal: Kulla
// & Conty, SIGGRAPH 2017 course) or enters the body (dielectric: Kelemen & Szirmay-Kalos, Eurographics 2001
// short papers) forms the base lobe (1-E(no))(1-E(ni)) / (pi (1-E_avg)), where E is the directional albedo of
// single reflection by facets.

#include <algorithm>
#include <array>
#include <cmath>

#include "render/brdf/brdf_model.h"

namespace hilcam {

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
// Returns the albedo of GGX facets that reflect everything (refractive_index 0) or like a dielectric.
// Midpoint sums over visible normals, good to 1e-3.
LobeAlbedo ggx_albedo(float alpha, float refractive_index);

// (1-E(no))(1-E(ni)) / (pi (1-E_avg)): the base lobe of light that a single reflection by facets leaves.
inline float below_facets(const LobeAlbedo& e, float no, float ni) {
    return e.average < 0.9999f ? (1 - e(no)) * (1 - e(ni)) / (kPiF * (1 - e.average)) : 0.0f;
}

// Returns Schlick's Fresnel term per bin for a facet at this cosine.
inline Spectrum schlick(const Spectrum& normal_reflectance, float cosine) {
    const float weight = schlick_weight(cosine);
    Spectrum out;
    for (int b = 0; b < kMaxBins; ++b) out[b] = normal_reflectance[b] + (1 - normal_reflectance[b]) * weight;
    return out;
}

// A model with a highlight from GGX facets of the surface's alpha; a mirror if that is 0. Its mirrored()
// gives the reflectance of a facet.
template <class Model>
struct FacetModel : BrdfModel<Model> {
    static constexpr bool kHasFacets = true;

    LobeAlbedo facets;

    Spectrum value(const BsdfInputs& at, Cosines c) const {
        Spectrum f = below_facets(facets, c.no, c.ni) * at.base;
        if (at.alpha > 0) {
            const HalfVector h = half_vector(c);
            f += ggx_distribution(at.alpha, h.nh) * ggx_visibility(at.alpha, c.no, c.ni) *
                 static_cast<const Model&>(*this).mirrored(at, h.ih);
        }
        return f;
    }
    float highlight_density(const BsdfInputs& at, Cosines c) const {
        return at.alpha > 0 ? ggx_density(at.alpha, c.no, half_vector(c).nh) : 0.0f;
    }
    Vec3f sample_highlight(const BsdfInputs& at, const Frame& local, Vec3f view_dir, float u1,
                           float u2) const {
        return sample_facets(at.alpha, local, view_dir, u1, u2);
    }
};

}  // namespace hilcam
