#pragma once
// The total share of light that a material reflects, by the cosine of the angle to its normal. The irradiance
// cache (irradiance_cache.h) needs no more of a BRDF, because it knows light only by its irradiance.

#include <array>

#include "render/scene/brdf.h"

namespace hilcam {

// Directional albedos at equal steps of the cosine, linear between them. They are integrated from the
// material's own samples (brdf.h), so it works the same for every model, and are good to 1e-3. By reciprocity
// the cosine may be that of the light or that of a viewer under uniform light.
class MaterialAlbedo {
  public:
    MaterialAlbedo() = default;
    // Numbers of samples of a direction: choices between the model's parts, and places along each side of a
    // square. With few choices narrow lobes are up to 0.015 off where the bins' colours differ.
    struct Samples {
        int choices, grid;
    };
    static constexpr Samples kUsual{8, 16}, kExact{32, 16};
    explicit MaterialAlbedo(const Material& material, Samples samples = kUsual);

    // Returns the share that facets reflect directly; zero for materials without facets.
    Spectrum lobe(float cosine) const { return at(lobe_, cosine); }
    // Returns the share of everything else, which is scattered in all directions.
    Spectrum base(float cosine) const { return at(base_, cosine); }
    // The same two under uniform light from all directions.
    const Spectrum& white_lobe() const { return white_lobe_; }
    const Spectrum& white_base() const { return white_base_; }

  private:
    static constexpr int kSteps = 16;
    using Table = std::array<Spectrum, kSteps + 1>;
    Table base_{}, lobe_{};
    Spectrum white_base_, white_lobe_;

    static Spectrum at(const Table& table, float cosine) {
        const float x = std::min(std::max(cosine, 0.0f), 1.0f) * kSteps;
        const int i = std::min(static_cast<int>(x), kSteps - 1);
        const float t = x - static_cast<float>(i);
        return (1 - t) * table[static_cast<std::size_t>(i)] + t * table[static_cast<std::size_t>(i) + 1];
    }
};

}  // namespace hilcam
