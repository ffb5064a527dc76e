#pragma once
// model: table. A measured, isotropic BRDF (brdf_table.h); `reflectance` is a factor on it, `table` is the
// file.

#include "render/brdf/brdf_model.h"
#include "render/brdf/brdf_table.h"
#include "render/vocabulary/check.h"

namespace hilcam::brdf {

struct Measured : BrdfModel<Measured> {
    static constexpr std::string_view kName = "table";
    static constexpr bool kTakesTable = true;
    static constexpr bool kAlbedoIsBound = true;

    std::shared_ptr<const BrdfTable> table;  // shared by surfaces of one measured material

    Measured(const Keys&, BrdfMaking& m) : table(m.table) { HILCAM_CHECK(table != nullptr); }

    Spectrum value(const BsdfInputs& at, Cosines c) const { return at.base * table->value(c.no, c.ni, c.io); }
    float highlight_chance(const BsdfInputs&, float) const { return table->lobe_share(); }
    float highlight_density(const BsdfInputs&, Cosines c) const {
        const float alpha = table->lobe_alpha();
        return alpha > 0 ? ggx_density(alpha, c.no, half_vector(c).nh) : 0.0f;
    }
    Vec3f sample_highlight(const BsdfInputs&, const Frame& local, Vec3f view_dir, float u1, float u2) const {
        return sample_facets(table->lobe_alpha(), local, view_dir, u1, u2);
    }
};

}  // namespace hilcam::brdf
