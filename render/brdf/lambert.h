#pragma once
// model: lambert. An ideal diffuse surface, equally bright from all sides (Lambert, Photometria, 1760): f =
// rho / pi with the albedo rho, `reflectance`.

#include "render/brdf/brdf_model.h"

namespace hilcam::brdf {

struct Lambert : BrdfModel<Lambert> {
    static constexpr std::string_view kName = "lambert";

    Lambert() = default;
    Lambert(const Keys&, BrdfMaking&) {}

    Spectrum value(const BsdfInputs& at, Cosines) const { return (1 / kPiF) * at.base; }
};

}  // namespace hilcam::brdf
