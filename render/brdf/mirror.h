#pragma once
// model: mirror. Exact reflection; `reflectance` is that at normal incidence, with Schlick's term towards
// grazing incidence (microfacet.h). If a path asks for a minimum lobe width, it is a facet lobe without
// shadowing losses.

#include "render/brdf/facet_lobe.h"

namespace hilcam::brdf {

struct Mirror : FacetModel<Mirror> {
    static constexpr std::string_view kName = "mirror";
    static constexpr bool kHasBody = false;

    Mirror(const Keys&, BrdfMaking& m) { m.look = {0, {}, m.look.base}; }

    Spectrum mirrored(const BsdfInputs& at, float cosine) const { return schlick(at.highlight, cosine); }
    float highlight_chance(const BsdfInputs&, float) const { return 1; }
    float albedo(const BsdfInputs& at, float, int bins) const { return mean(at.highlight, bins); }
};

}  // namespace hilcam::brdf
