#pragma once
// model: phong. For legacy data: Lafortune & Willems, "Using the modified Phong reflectance model for
// physically based rendering", 1994: f = k_d / pi + k_s (n+2)/2pi cos^n of the angle to the mirror direction.
// Reciprocal; conserves energy if k_d (`reflectance`) and k_s (`specular`) sum to at most 1.

#include "render/brdf/brdf_model.h"
#include "render/vocabulary/check.h"

namespace hilcam::brdf {

struct Phong : BrdfModel<Phong> {
    static constexpr std::string_view kName = "phong";

    struct Keys {
        Curve specular = Curve::constant(0);
        double exponent = 10;
    };
    static Fields fields(Keys& k) {
        return {curve("specular", k.specular, {0, 1}, "k_s of phong"),
                number("exponent", k.exponent, 1, {0, 1e5}, "n of phong")};
    }
    static void check(const MaterialKeys& shared, const Keys& k) {
        if (largest_value(shared.reflectance) + largest_value(k.specular) > 1)
            throw InputError(
                "'reflectance' and 'specular' of phong add up to more than 1 at most; light would be "
                "created");
    }

    float exponent;

    Phong(const Keys& k, BrdfMaking& m) : exponent(static_cast<float>(k.exponent)) {
        m.look.highlight = m.average(k.specular, "specular");
    }

    Spectrum value(const BsdfInputs& at, Cosines c) const {
        return lobe(exponent + 2, c) * at.highlight + (1 / kPiF) * at.base;
    }
    float highlight_chance(const BsdfInputs& at, float) const {
        const float top = max_component(at.highlight), below = max_component(at.base);
        return top + below > 0 ? top / (top + below) : 0.0f;
    }
    float highlight_density(const BsdfInputs&, Cosines c) const { return lobe(exponent + 1, c); }
    // Draws around the mirror direction: cos^n (Lafortune & Willems 1994, eq. 10).
    Vec3f sample_highlight(const BsdfInputs&, const Frame& local, Vec3f view_dir, float u1, float u2) const {
        const float z = std::pow(u1, 1 / (exponent + 1));
        const float r = std::sqrt(std::max(0.0f, 1 - z * z)), phi = 2 * kPiF * u2;
        return Frame(normalized(reflect(view_dir, local.n)))
            .to_world({r * std::cos(phi), r * std::sin(phi), z});
    }
    float albedo(const BsdfInputs& at, float, int bins) const {
        return mean(at.base, bins) + mean(at.highlight, bins);
    }

  private:
    float lobe(float factor, Cosines c) const {
        const float cosine = std::clamp(2 * c.no * c.ni - c.io, 0.0f, 1.0f);
        return factor / (2 * kPiF) * std::pow(cosine, exponent);
    }
};

}  // namespace hilcam::brdf
