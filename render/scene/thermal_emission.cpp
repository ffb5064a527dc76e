#include "render/scene/thermal_emission.h"

#include <algorithm>

#include "render/scene/material_albedo.h"

namespace hilcam {

ThermalEmission::ThermalEmission(const Material& material, const SpectralGrid& grid, double temperature_k) {
    if (!(temperature_k > 0)) return;
    const Spectrum black = planck_w_m2_sr_um(grid, temperature_k);
    if (std::holds_alternative<brdf::Lambert>(material.brdf)) {
        // Its share is known exactly, which counts where it is nearly 1.
        for (int b = 0; b < grid.size(); ++b) mean_[b] = (1 - material.base[b]) * black[b];
        at_.fill(mean_);
        return;
    }
    const MaterialAlbedo albedo(material, MaterialAlbedo::kExact);
    const Bsdf surface{&material, material.ggx_alpha, material.base, material.highlight};
    for (std::size_t i = 0; i <= kSteps; ++i) {
        const float cosine = static_cast<float>(i) / kSteps;
        const Spectrum sent =
            albedo.lobe(cosine) + albedo.base(cosine) + sheet_transmittance(surface, std::max(cosine, 1e-3f));
        for (int b = 0; b < grid.size(); ++b) at_[i][b] = std::max(0.0f, 1 - sent[b]) * black[b];
        // 2 cos d cos, by the trapezoid rule.
        const float weight =
            (i == 0 || i == kSteps ? 1.0f : 2.0f) * static_cast<float>(i) / (kSteps * kSteps);
        mean_ += weight * at_[i];
    }
}

}  // namespace hilcam
