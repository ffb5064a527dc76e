#pragma once
// model: veil. A thin layer with holes too small to be seen one by one, such as a net or gauze. The share
// `cover` is an ideal diffuse surface of albedo `reflectance`; through the rest light passes straight on.
// Mesh files mean this by alpha as coverage (Porter & Duff, "Compositing digital images", SIGGRAPH 84).

#include "render/brdf/brdf_model.h"

namespace hilcam::brdf {

struct Veil : BrdfModel<Veil> {
    static constexpr std::string_view kName = "veil";
    static constexpr bool kTransmits = true;

    struct Keys {
        double cover = 0.5;
    };
    static Fields fields(Keys& k) {
        return {number("cover", k.cover, 1, {0, 1}, "share of a veil's area that is not holes")};
    }

    float cover;

    Veil(const Keys& k, BrdfMaking& m) : cover(static_cast<float>(k.cover)) {
        m.look.base = cover * m.look.base;
    }

    Spectrum value(const BsdfInputs& at, Cosines) const { return (1 / kPiF) * at.base; }
    Spectrum passed(const BsdfInputs&, float) const {
        Spectrum out;
        out.bin.fill(1 - cover);
        return out;
    }
};

}  // namespace hilcam::brdf
