#pragma once
// Rough diffuse reflection and Phong's lobe, as BRDFs [sr^-1] of the three cosines no, ni and io (viewer and
// light against the normal, and against each other).

#include <algorithm>
#include <cmath>

#include "render/scene/brdf_microfacet.h"

namespace hilcam {

// Oren and Nayar's rough diffuse surface in the form that conserves energy: Fujii's angular part with the
// light that scatters between facets given back (Portsmouth, Kutz & Hill, "EON: a practical energy-preserving
// rough diffuse BRDF", JCGT 14(1), 2025). roughness r 0..1; Oren-Nayar's slope deviation sigma [rad] gives
// about r = sigma / (pi/2).
struct OrenNayar {
    float roughness;
    float a;        // A of Fujii's model: 1 / (1 + (1/2 - 2/3pi) r)
    float average;  // mean albedo of the single scattering for a white surface

    explicit OrenNayar(float r)
        : roughness(r),
          a(1 / (1 + (0.5f - 2 / (3 * kPiF)) * r)),
          average(a * (1 + (2.0f / 3 - 28 / (15 * kPiF)) * r)) {}

    // Directional albedo of the single scattering for a white surface.
    float albedo(float cosine) const {
        const float c = std::clamp(cosine, 1e-4f, 1.0f);
        const float s = std::sqrt(std::max(0.0f, 1 - c * c));
        const float g = s * (std::acos(c) - s * c) + 2.0f / 3 * (s / c * (1 - s * s * s) - s);
        return a * (1 + roughness / kPiF * g);
    }
    // Single scattering for a white surface.
    float single(float no, float ni, float io) const {
        const float s = io - no * ni;
        return a / kPiF * (1 + roughness * (s > 0 ? s / std::max({no, ni, 1e-6f}) : s));
    }
    // Light that met several facets, for a white surface; times multiple_color().
    float multiple(float no, float ni) const {
        return average < 1 ? (1 - albedo(no)) * (1 - albedo(ni)) / (kPiF * (1 - average)) : 0.0f;
    }
    float multiple_color(float reflectance) const {
        return reflectance * reflectance * average / (1 - reflectance * (1 - average));
    }
};

// Lafortune & Willems, "Using the modified Phong reflectance model", 1994: (n+2)/2pi cos^n of the angle to
// the mirror direction. Reciprocal; conserves energy when both reflectances sum to at most 1.
inline float phong_lobe(float exponent, float no, float ni, float io) {
    const float c = std::clamp(2 * no * ni - io, 0.0f, 1.0f);
    return (exponent + 2) / (2 * kPiF) * std::pow(c, exponent);
}
inline float phong_density(float exponent, float no, float ni, float io) {
    const float c = std::clamp(2 * no * ni - io, 0.0f, 1.0f);
    return (exponent + 1) / (2 * kPiF) * std::pow(c, exponent);
}

}  // namespace hilcam
