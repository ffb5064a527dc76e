#pragma once
// The light of a facet lobe, from the rays of the pixels around it. See docs/rendering.md, "Glossy light by
// width".
//
// Each ray gives the radiance of the place that it has met. A lobe weights it by its BRDF towards that place
// over the density of the ray's direction, and takes the weighted mean (ratio estimator of ray reuse:
// Stachowiak & Uludag, Stochastic Screen-Space Reflections, SIGGRAPH 2015 courses). Directions follow a
// pattern of 8 x 8 pixels (kGlossyPattern_px), and every window of that size contains each of its directions
// once (interleaved sampling: Keller & Heidrich, EGWR 2001).
//
// Not modelled: an obstacle between a lobe and the place that its neighbour's ray has met.

#include <cstdint>

#include "render/glossy/glossy_buffer.h"

namespace hilcam {

inline constexpr int kGlossyPattern_px = 8;

// Returns the two numbers in [0, 1) that choose the direction of a pixel's ray, by its number. reach_px: 8
// or 4. They follow Sobol's (0, 2)-sequence, of which 2 x 2 pixels have successive places, so over any 8 x 8
// pixels with one ray each, or 4 x 4 pixels with four, they are in 64 different squares, and each coordinate
// is in 64 different strips.
struct GlossyPlace {
    float u1, u2;
};
GlossyPlace glossy_place(int x, int y, int ray, int reach_px);

// Returns the standard error of a lobe's light, from the rays of the pixels in `within`: radiance times its
// samples, largest bin. x, y: pixel of the point. Loop, any thread, while no other thread links rays there.
float glossy_error(const GlossyBuffer& buffer, const GlossyPoint& at, int x, int y, const PixelBox& within);

// The light that a lobe sends to its pixel: radiance times its samples.
struct GlossyLight {
    Spectrum surfaces, bodies;
};
// x, y: pixel of the point. Loop, any thread.
GlossyLight reused_light(const GlossyBuffer& buffer, const GlossyPoint& at, int x, int y);

}  // namespace hilcam
