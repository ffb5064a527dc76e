#pragma once
// model: lommel_seeliger. Single scattering in dark powder: f = w/4pi / (mu_0 + mu), with a phase function of
// 1 (von Seeliger 1887; B. Hapke, Theory of Reflectance and Emittance Spectroscopy, 2nd ed., Cambridge 2012,
// 8.5). `reflectance` is I/F at normal incidence and zero phase, which is w/8.

#include "render/brdf/brdf_model.h"
#include "render/vocabulary/check.h"

namespace hilcam::brdf {

struct LommelSeeliger : BrdfModel<LommelSeeliger> {
    static constexpr std::string_view kName = "lommel_seeliger";
    static constexpr bool kAlbedoIsBound = true;

    // The albedo w/2 (1 - mu ln(1 + 1/mu)) is at most w/2 = 4 I/F.
    static void check(const MaterialKeys& shared, const Keys&) {
        if (largest_value(shared.reflectance) > 0.25)
            throw InputError(
                "'reflectance' of lommel_seeliger is above 0.25, where grazing light would be created");
    }

    LommelSeeliger(const Keys&, BrdfMaking& m) {
        for (float& w : m.look.base.bin) w *= 8;
    }

    Spectrum value(const BsdfInputs& at, Cosines c) const { return 1 / (4 * kPiF * (c.no + c.ni)) * at.base; }
};

}  // namespace hilcam::brdf
