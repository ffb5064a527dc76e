#pragma once
// The light that a surface emits by its temperature: Planck's law times the emissivity in each direction,
// which is what it neither reflects nor passes (Kirchhoff 1860). So the surfaces of a closed room at one
// temperature look alike, whatever their materials.

#include <algorithm>
#include <array>
#include <cstddef>

#include "render/vocabulary/spectrum.h"

namespace hilcam {

struct Material;

class ThermalEmission {
  public:
    ThermalEmission() = default;
    // Emits the same in all directions.
    explicit ThermalEmission(const Spectrum& radiance_w_m2_sr_um) : mean_(radiance_w_m2_sr_um) {
        at_.fill(radiance_w_m2_sr_um);
    }
    // temperature_k: 0: nothing is emitted.
    ThermalEmission(const Material& material, const SpectralGrid& grid, double temperature_k);

    // Returns the emitted radiance [W m^-2 sr^-1 um^-1] at a cosine to the normal: linear between 16 steps.
    // Loop, any thread.
    Spectrum towards(float cosine) const {
        const float x = std::min(std::max(cosine, 0.0f), 1.0f) * kSteps;
        const auto i = std::min(static_cast<std::size_t>(x), kSteps - 1);
        const float t = x - static_cast<float>(i);
        return (1 - t) * at_[i] + t * at_[i + 1];
    }
    // Returns the radiance of a surface that emits the same power evenly: what leaves it over pi.
    const Spectrum& mean() const { return mean_; }
    bool none() const { return !(max_component(mean_) > 0); }

  private:
    static constexpr std::size_t kSteps = 16;
    std::array<Spectrum, kSteps + 1> at_{};
    Spectrum mean_;
};

}  // namespace hilcam
