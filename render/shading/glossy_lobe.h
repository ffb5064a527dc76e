#pragma once
// The light that rays along one shading point's facet lobe find, where cached light hangs on few directions (indirect_cache.h),
// and how far that is believed.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/subpixel_light.h"

namespace hilcam {

// A pixel that has part of the light of one lobe's rays.
struct PixelShare {
    std::uint32_t pixel;      // in the tile
    SubpixelMoments moments;  // where in the pixel it is
    Spectrum share;           // part of the light as the shading point sends it, with the pixel's own colour
};

// The light that rays find which follow one shading point's lobe, until all have come back.
struct GlossyLobe {
    static constexpr std::size_t kMaxRays = 32;
    std::span<const PixelShare> pixels;    // that have it
    float cached = 0;                      // cached light in the lobe, as the sum of by_ray
    float cached_directions = 0;           // that bring that (IrradianceCache::Lobe)
    Spectrum sky, light;                   // light of rays that meet nothing, and of all others
    std::array<float, kMaxRays> by_ray{};  // the latter's greatest bin
    float found = 0;                       // sum of these

    void add(std::size_t ray, const Spectrum& more) {
        const float brightest = max_component(more);
        light += more, by_ray[ray] += brightest, found += brightest;
    }
    // Returns as much of what is found as is believed at this one shading point.
    float believed() const;
    // Returns what the shading point sends where so much is believed.
    Spectrum sum(float light_believed) const;
};
// Returns the factor on what is believed of each by which all together send what their rays have found: what one shading point
// does not have, those about it have. At least 1.
float found_over_believed(std::span<const GlossyLobe> lobes);

}  // namespace hilcam
