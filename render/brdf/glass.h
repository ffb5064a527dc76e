#pragma once
// model: glass. A thin clear sheet: exact reflection and straight transmission, including light that bounces
// inside it (the geometric series of a plate's bounces, Born & Wolf, Principles of Optics, chapter 7.6, with
// intensities added). `refractive_index` is that of the sheet, `transmittance` the one inside it at normal
// incidence; `reflectance` is not used.

#include "render/brdf/brdf_model.h"

namespace hilcam::brdf {

struct Glass : BrdfModel<Glass> {
    static constexpr std::string_view kName = "glass";
    static constexpr std::array<std::string_view, 1> kSharedKeys{"refractive_index"};
    static constexpr bool kTransmits = true;
    static constexpr bool kHasBody = false;

    struct Keys {
        Curve transmittance = Curve::constant(1);
    };
    static Fields fields(Keys& k) {
        return {curve("transmittance", k.transmittance, {0, 1},
                      "transmittance inside a glass sheet, at normal incidence")};
    }

    float refractive_index;

    Glass(const Keys& k, BrdfMaking& m) : refractive_index(static_cast<float>(m.keys.refractive_index)) {
        m.look = {0, {}, m.average(k.transmittance, "transmittance")};
    }

    Spectrum value(const BsdfInputs&, Cosines) const { return {}; }
    Spectrum mirrored(const BsdfInputs& at, float cosine) const {
        const float f = fresnel_dielectric(refractive_index, cosine);
        Spectrum out;
        for (int b = 0; b < kMaxBins; ++b) {
            const float t = inside(at, b, cosine), below = 1 - f * f * t * t;
            out[b] = f + f * (1 - f) * (1 - f) * t * t / below;
        }
        return out;
    }
    Spectrum passed(const BsdfInputs& at, float cosine) const {
        const float f = fresnel_dielectric(refractive_index, cosine);
        Spectrum out;
        for (int b = 0; b < kMaxBins; ++b) {
            const float t = inside(at, b, cosine), below = 1 - f * f * t * t;
            out[b] = (1 - f) * (1 - f) * t / below;
        }
        return out;
    }
    float albedo(const BsdfInputs&, float, int) const { return 1; }

  private:
    // Returns the transmittance of one passage: the path inside is longer by the refracted angle (Snell).
    float inside(const BsdfInputs& at, int bin, float cosine) const {
        const float n = refractive_index;
        const float slant = std::sqrt(std::max(1e-6f, 1 - (1 - cosine * cosine) / (n * n)));
        return at.highlight[bin] > 0 ? std::pow(at.highlight[bin], 1 / slant) : 0.0f;
    }
};

}  // namespace hilcam::brdf
