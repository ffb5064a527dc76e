#pragma once
// model: oren_nayar. A rough diffuse surface: the energy-conserving form of Oren and Nayar's model, with
// Fujii's angular part and the light that is scattered between facets (Portsmouth, Kutz & Hill, "EON: a
// practical energy-preserving rough diffuse BRDF", JCGT 14(1), 2025). `reflectance` is the facets' albedo,
// `roughness` r is 0..1; Oren-Nayar's slope deviation sigma [rad] corresponds to about r = sigma / (pi/2).

#include "render/brdf/brdf_model.h"

namespace hilcam::brdf {

struct OrenNayar : BrdfModel<OrenNayar> {
    static constexpr std::string_view kName = "oren_nayar";
    static constexpr std::array<std::string_view, 2> kSharedKeys{"reflectance", "roughness"};

    float roughness;
    float a;        // factor of Fujii's model: 1 / (1 + (1/2 - 2/3pi) r)
    float average;  // mean albedo of single scattering for a white surface

    OrenNayar(const Keys&, BrdfMaking& m)
        : roughness(static_cast<float>(m.keys.roughness)),
          a(1 / (1 + (0.5f - 2 / (3 * kPiF)) * roughness)),
          average(a * (1 + (2.0f / 3 - 28 / (15 * kPiF)) * roughness)) {}

    Spectrum value(const BsdfInputs& at, Cosines c) const {
        const float once = single(c.no, c.ni, c.io), often = multiple(c.no, c.ni);
        Spectrum f;
        for (int b = 0; b < kMaxBins; ++b) f[b] = once * at.base[b] + often * multiple_color(at.base[b]);
        return f;
    }

  private:
    // Returns the directional albedo of single scattering for a white surface.
    float single_albedo(float cosine) const {
        const float c = std::clamp(cosine, 1e-4f, 1.0f);
        const float s = std::sqrt(std::max(0.0f, 1 - c * c));
        const float g = s * (std::acos(c) - s * c) + 2.0f / 3 * (s / c * (1 - s * s * s) - s);
        return a * (1 + roughness / kPiF * g);
    }
    // Returns the single scattering of a white surface.
    float single(float no, float ni, float io) const {
        const float s = io - no * ni;
        return a / kPiF * (1 + roughness * (s > 0 ? s / std::max({no, ni, 1e-6f}) : s));
    }
    // Returns the light that met several facets, for a white surface; to be multiplied by multiple_color().
    float multiple(float no, float ni) const {
        return average < 1 ? (1 - single_albedo(no)) * (1 - single_albedo(ni)) / (kPiF * (1 - average))
                           : 0.0f;
    }
    float multiple_color(float reflectance) const {
        return reflectance * reflectance * average / (1 - reflectance * (1 - average));
    }
};

}  // namespace hilcam::brdf
