#include "render/brdf/facet_lobe.h"

namespace hilcam {
namespace {

// Returns the mean albedo of a single reflection by a facet lobe, with the facet's Fresnel term or 1.
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
        // Denser where facets are steep (u near 1): they are few, but all of the loss is there.
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

LobeAlbedo ggx_albedo(float alpha, float refractive_index) {
    LobeAlbedo out;
    constexpr int n = LobeAlbedo::kSteps;
    for (int i = 0; i <= n; ++i)
        out.at_cosine[static_cast<std::size_t>(i)] =
            lobe_albedo(alpha, refractive_index, static_cast<float>(i) / static_cast<float>(n));
    // 2 int E mu dmu, exact for the linear pieces that operator() uses.
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

}  // namespace hilcam
