#pragma once
// The parameters of Hapke's law except the single-scattering albedo (render/brdf/hapke.h). They come from a
// material, or, for ground, from maps.

namespace hilcam {

struct HapkeParameters {
    float b = 0.25f, c = 0.5f;    // Henyey-Greenstein: width of both lobes, (1+c)/2 is the backward share
    float surge_amplitude = 0;    // B0
    float surge_width = 0.05f;    // h
    float roughness_tangent = 0;  // tan of the mean slope theta-bar

    friend bool operator==(const HapkeParameters&, const HapkeParameters&) = default;
};

// The range that the law accepts for a parameter.
struct ParameterLimits {
    double least, most;
};
inline constexpr ParameterLimits kLobeWidthLimits{0, 0.95}, kLobeBackwardLimits{-1, 1},
    kSurgeAmplitudeLimits{0, 10}, kSurgeWidthLimits{1e-4, 1}, kSlopeLimits_deg{0, 60};

// Returns the weighted mean of three sets.
inline HapkeParameters blend(const HapkeParameters& p, float p_share, const HapkeParameters& q, float q_share,
                             const HapkeParameters& r, float r_share) {
    const auto mean = [&](float HapkeParameters::*of) {
        return p_share * p.*of + q_share * q.*of + r_share * r.*of;
    };
    return {mean(&HapkeParameters::b), mean(&HapkeParameters::c), mean(&HapkeParameters::surge_amplitude),
            mean(&HapkeParameters::surge_width), mean(&HapkeParameters::roughness_tangent)};
}

}  // namespace hilcam
