#include "render/scene/material_albedo.h"

#include <algorithm>
#include <cmath>

#include "render/brdf/microfacet.h"

namespace hilcam {
namespace {

// The mean weight of samples on a grid of places: the directional albedo.
Spectrum total(const Bsdf& at, float cosine, MaterialAlbedo::Samples samples) {
    const auto [choices, grid] = samples;
    const auto middle = [](int i, int count) {
        return (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
    };
    const Vec3f normal{0, 0, 1}, view{std::sqrt(std::max(0.0f, 1 - cosine * cosine)), 0, cosine};
    Spectrum sum;
    for (int c = 0; c < choices; ++c)
        for (int i = 0; i < grid; ++i)
            for (int k = 0; k < grid; ++k) {
                const BrdfSample sample =
                    brdf_sample(at, normal, view, {middle(c, choices), middle(i, grid), middle(k, grid)});
                if (sample.valid && !sample.transmits) sum += sample.weight;
            }
    return (1.0f / static_cast<float>(choices * grid * grid)) * sum;
}

}  // namespace

MaterialAlbedo::MaterialAlbedo(const Material& material, Samples samples) {
    const Bsdf at{&material, material.has_facets() ? material.ggx_alpha : 0.0f, material.base,
                  material.highlight};
    for (int i = 0; i <= kSteps; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const float cosine = std::max(1e-3f, static_cast<float>(i) / kSteps);
        const Spectrum all = total(at, cosine, samples);
        if (!material.has_facets()) {
            base_[k] = all;
        } else {
            // The base is light that leaves the facets after several reflections or enters the body
            // (facet_lobe.h).
            base_[k] = std::max(0.0f, brdf_below_facets(material, cosine)) * material.base;
            for (int b = 0; b < kMaxBins; ++b) lobe_[k][b] = std::max(0.0f, all[b] - base_[k][b]);
        }
        // 2 cos d cos, by the trapezoid rule.
        const float weight =
            (i == 0 || i == kSteps ? 1.0f : 2.0f) * static_cast<float>(i) / (kSteps * kSteps);
        white_base_ += weight * base_[k], white_lobe_ += weight * lobe_[k];
    }
}

}  // namespace hilcam
