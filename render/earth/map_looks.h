#pragma once
// The lookups that a footprint on the ground makes in a map with mip levels: several along its longer axis,
// each as wide as the shorter (McCormack et al., SIGGRAPH 99).

#include <algorithm>
#include <cmath>

#include "render/earth/earth_map.h"

namespace hilcam {

// The size in texels of the finest map.
struct MapSize {
    float width, height;
};

// The texel width of the level that a lookup uses, relative to its own width. A texel that is a mean,
// interpolated linearly to its neighbours, has a variance of a quarter of its squared width; a pixel has a
// twelfth, a third of the blur. 0.58 would give equal blur but lets finer structure through; 0.7 is nearest
// to a pixel's mean (docs/decisions.md#the-earth-smooth-light-sharp-maps).
inline constexpr float kTexelOfLook = 0.7f;

// The ellipse with a footprint's sides as conjugate half diameters, in texels: sums of squares along and
// across the map, and its axes.
struct FootprintEllipse {
    float xx, xy, yy, longer, shorter;
};
inline FootprintEllipse ellipse_of(const MapFootprint& f, MapSize size) {
    const float a1 = size.width * f.u1, b1 = size.height * f.v1, a2 = size.width * f.u2,
                b2 = size.height * f.v2;
    const float xx = a1 * a1 + a2 * a2, xy = a1 * b1 + a2 * b2, yy = b1 * b1 + b2 * b2;
    const float middle = 0.5f * (xx + yy), off = std::sqrt(0.25f * (xx - yy) * (xx - yy) + xy * xy);
    return {xx, xy, yy, std::sqrt(middle + off), std::sqrt(std::max(0.0f, middle - off))};
}

// Calls add(u, v, level, weight) for each lookup; weights sum to 1. level: base-2 logarithm of the texel
// width to use, at least 0. Loop, any thread.
template <class Add>
void each_look(float u, float v, const MapFootprint& f, MapSize size, const Add& add) {
    constexpr int kMaxLooks = 8;
    const auto [xx, xy, yy, longer, shorter] = ellipse_of(f, size);
    const float width = std::max({shorter, longer / kMaxLooks, 1.0f});
    const float level = std::max(0.0f, std::log2(kTexelOfLook * width));
    const int looks = std::clamp(static_cast<int>(std::ceil(longer / width - 0.25f)), 1, kMaxLooks);
    if (looks == 1) return add(u, v, level, 1.0f);
    // The direction of the longer axis: the eigenvector of the larger eigenvalue, which is its square.
    float dx = xx > yy ? longer * longer - yy : xy, dy = xx > yy ? xy : longer * longer - xx;
    const float norm = std::sqrt(dx * dx + dy * dy);
    const float per_norm = norm > 0 ? longer / norm : 0;
    dx *= per_norm / size.width, dy *= per_norm / size.height;
    const float share = 1 / static_cast<float>(looks);
    for (int i = 0; i < looks; ++i) {
        const float t = (static_cast<float>(i) + 0.5f) * share - 0.5f;
        add(u + t * dx, v + t * dy, level, share);
    }
}

}  // namespace hilcam
