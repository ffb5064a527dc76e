#pragma once
// Rays along glossy lobes as arrays, one for each quantity, in the order of their pixels. So the rays of
// neighbouring pixels in a row are neighbours in the arrays, and a lobe weighs a vector of them at a time
// (glossy_window.h).

#include <array>
#include <cstddef>
#include <cstdint>

#include "render/planetshine/planetshine.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

// The values of a ray that a lobe sums, with a weight for each ray. They fill a cache line.
struct alignas(64) GlossySum {
    Spectrum light;  // radiance of the place that is met; none if the ray meets nothing
    std::array<float, Planetshine::kMaxBodies>
        towards{};                                      // radiance of each body along the ray, hidden or not
    std::array<float, Planetshine::kMaxBodies> free{};  // the same if the ray meets nothing, else 0
    std::array<float, 8 - 2 * Planetshine::kMaxBodies> unused{};

    float brightest() const { return max_component(light); }
    float of_bodies() const {
        float sum = 0;
        for (const float body : free) sum += body;
        return sum;
    }
};
static_assert(sizeof(GlossySum) == 64);

struct GlossyColumns {
    static constexpr std::size_t kPadding = 16;  // vectors may read as far past the last ray

    // The lobe's place and normal in ray space, the column of its pixel, its object and side (glossy_side()).
    float *start_x, *start_y, *start_z;
    float *normal_x, *normal_y, *normal_z;
    float* column_px;
    std::uint32_t *object, *side;
    // The place that is met, ray space, and 1; or the direction of a ray that meets nothing, and 0.
    float *met_x, *met_y, *met_z, *hit;
    float* per_density_sr;  // 1 / density of its direction
    GlossySum* sum;
};

// Returns a number for one side of an object's surface.
inline std::uint32_t glossy_side(std::uint16_t surface, bool back) {
    return 2 * std::uint32_t{surface} + (back ? 1 : 0);
}

}  // namespace hilcam
