#pragma once
// model: hapke. Regolith, f = I / (E cos i) [sr^-1]: B. Hapke, Theory of Reflectance and Emittance
// Spectroscopy, 2nd ed., Cambridge 2012:
//     f = w/4pi 1/(mu_0e + mu_e) { [1 + B(g)] p(g) + H(mu_0e) H(mu_e) - 1 } S(i, e, psi) mu_0e / mu_0
// H is from Hapke 2002 (Icarus 157, 523, eq. 13), p is a double Henyey-Greenstein function, B the
// shadow-hiding surge of 1986, S and the effective cosines the macroscopic roughness of 1984 (Icarus 59, 41).
// `reflectance` is the single-scattering albedo w. Maps of the ground can give the other parameters by place.
// Not modelled: porosity, coherent backscatter, polarisation.

#include "render/brdf/brdf_model.h"
#include "render/vocabulary/hapke_parameters.h"
#include "render/vocabulary/units.h"

namespace hilcam {

// --- the law by itself

// The part of the law that does not depend on wavelength.
struct HapkeGeometry {
    float mu0 = 0, mu = 0;  // effective cosines
    float phase = 0;        // (1 + B) p
    float factor = 0;       // 1/4pi 1/(mu0 + mu) S mu0e / cos i
};

// io: cosine between the directions to light and viewer, that is, of the phase angle g.
inline HapkeGeometry hapke_geometry(const HapkeParameters& p, float no, float ni, float io) {
    HapkeGeometry out;
    const float cos_g = std::clamp(io, -1.0f, 1.0f);
    // The backward lobe peaks at g = 0, where the scattering angle is pi.
    const float b2 = p.b * p.b;
    const auto lobe = [&](float sign) {
        const float x = 1 + sign * 2 * p.b * cos_g + b2;
        return (1 - b2) / (x * std::sqrt(x));
    };
    const float hg = 0.5f * (1 + p.c) * lobe(-1) + 0.5f * (1 - p.c) * lobe(1);
    const float tan_half_g = std::sqrt((1 - cos_g) / std::max(1e-12f, 1 + cos_g));
    const float surge = p.surge_amplitude > 0 ? p.surge_amplitude / (1 + tan_half_g / p.surge_width) : 0.0f;
    out.phase = (1 + surge) * hg;
    out.mu0 = ni, out.mu = no;
    float shadowing = 1;
    if (p.roughness_tangent > 0) {
        // Hapke 1984, eqs. 45-60. i, e: angles of light and viewer; psi: azimuth between them.
        const float t = p.roughness_tangent;
        const float chi = 1 / std::sqrt(1 + kPiF * t * t);
        const float sin_i = std::sqrt(std::max(0.0f, 1 - ni * ni)),
                    sin_e = std::sqrt(std::max(0.0f, 1 - no * no));
        const float cos_psi =
            sin_i * sin_e > 1e-9f ? std::clamp((cos_g - ni * no) / (sin_i * sin_e), -1.0f, 1.0f) : 1.0f;
        const float psi = std::acos(cos_psi);
        const float half = std::sin(0.5f * psi) * std::sin(0.5f * psi);
        const float f = std::exp(-2 * std::tan(0.5f * std::min(psi, 3.1415f)));
        const auto e1 = [&](float sine, float cosine) {
            return sine > 0 ? std::exp(-2 / kPiF * cosine / (sine * t)) : 0.0f;
        };
        const auto e2 = [&](float sine, float cosine) {
            return sine > 0 ? std::exp(-1 / kPiF * (cosine / sine) * (cosine / sine) / (t * t)) : 0.0f;
        };
        const float e1i = e1(sin_i, ni), e2i = e2(sin_i, ni), e1e = e1(sin_e, no), e2e = e2(sin_e, no);
        // Effective cosines with light and viewer in one plane.
        const float eta_i = chi * (ni + sin_i * t * e2i / (2 - e1i));
        const float eta_e = chi * (no + sin_e * t * e2e / (2 - e1e));
        if (ni >= no) {  // i <= e
            const float below = 2 - e1e - psi / kPiF * e1i;
            out.mu0 = chi * (ni + sin_i * t * (cos_psi * e2e + half * e2i) / below);
            out.mu = chi * (no + sin_e * t * (e2e - half * e2i) / below);
            shadowing = out.mu / eta_e * ni / eta_i * chi / (1 - f + f * chi * ni / eta_i);
        } else {
            const float below = 2 - e1i - psi / kPiF * e1e;
            out.mu0 = chi * (ni + sin_i * t * (e2i - half * e2e) / below);
            out.mu = chi * (no + sin_e * t * (cos_psi * e2i + half * e2e) / below);
            shadowing = out.mu / eta_e * ni / eta_i * chi / (1 - f + f * chi * no / eta_e);
        }
        out.mu0 = std::max(out.mu0, 1e-6f), out.mu = std::max(out.mu, 1e-6f);
        shadowing = std::max(0.0f, shadowing);
    }
    out.factor = shadowing * out.mu0 / (std::max(ni, 1e-6f) * 4 * kPiF * (out.mu0 + out.mu));
    return out;
}

// Chandrasekhar's H function, approximated to 1 % (Hapke 2002, eq. 13). albedo: single scattering, 0..1.
inline float hapke_h(float albedo, float x) {
    const float gamma = std::sqrt(std::max(0.0f, 1 - albedo));
    const float r0 = (1 - gamma) / (1 + gamma);
    return 1 / (1 - albedo * x * (r0 + 0.5f * (1 - 2 * r0 * x) * std::log((1 + x) / x)));
}

inline float hapke(const HapkeGeometry& g, float albedo) {
    return albedo * g.factor * (g.phase + hapke_h(albedo, g.mu0) * hapke_h(albedo, g.mu) - 1);
}

namespace brdf {

struct Hapke : BrdfModel<Hapke> {
    static constexpr std::string_view kName = "hapke";
    static constexpr bool kAlbedoIsBound = true;

    struct Keys {
        double lobe_width = 0.25, lobe_backward = 0.5;  // b and c of the Henyey-Greenstein lobes
        double surge_amplitude = 0, surge_width = 0.05;
        double slope_rad = 0;  // mean slope theta-bar
    };
    static Fields fields(Keys& k) {
        const auto range = [](const ParameterLimits& limits) { return Range{limits.least, limits.most}; };
        return {number("lobe_width", k.lobe_width, 1, range(kLobeWidthLimits), "b of hapke"),
                number("lobe_backward", k.lobe_backward, 1, range(kLobeBackwardLimits),
                       "c of hapke: (1+c)/2 of the light goes backward"),
                number("surge_amplitude", k.surge_amplitude, 1, range(kSurgeAmplitudeLimits),
                       "B0 of hapke: opposition surge"),
                number("surge_width", k.surge_width, 1, range(kSurgeWidthLimits),
                       "h of hapke: width of the opposition surge"),
                number("slope_deg", k.slope_rad, kDegree_rad, range(kSlopeLimits_deg),
                       "theta-bar of hapke: mean slope of the surface")};
    }

    HapkeParameters parameters;

    Hapke(const Keys& k, BrdfMaking&)
        : parameters{static_cast<float>(k.lobe_width), static_cast<float>(k.lobe_backward),
                     static_cast<float>(k.surge_amplitude), static_cast<float>(k.surge_width),
                     static_cast<float>(std::tan(k.slope_rad))} {}

    Spectrum value(const BsdfInputs& at, Cosines c) const {
        const HapkeGeometry g = hapke_geometry(at.hapke.value_or(parameters), c.no, c.ni, c.io);
        Spectrum f;
        for (int b = 0; b < kMaxBins; ++b) f[b] = hapke(g, at.base[b]);
        return f;
    }
};

}  // namespace brdf
}  // namespace hilcam
