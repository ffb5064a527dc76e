#pragma once
// The share of light that a material reflects in all, by the cosine of the angle to its normal: all that kept
// light (irradiance_cache.h) needs of a BRDF, as it knows light only by the irradiance that it makes.

#include <array>

#include "render/scene/brdf.h"

namespace hilcam {

// Directional albedos at equal steps of the cosine, linear between them; integrated from the material's own
// samples (brdf.h), so for every model the same way: good to 1e-3. By reciprocity they hold for the direction
// to the light under a wide sky's view and for the direction to the viewer under a wide sky.
class MaterialAlbedo {
  public:
    MaterialAlbedo() = default;
    explicit MaterialAlbedo(const Material& material);

    // This is what facets reflect at once; zero for materials without them.
    Spectrum lobe(float cosine) const { return at(lobe_, cosine); }
    // This is all the rest, which goes everywhere.
    Spectrum base(float cosine) const { return at(base_, cosine); }
    // These are the same two, under light from everywhere.
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
