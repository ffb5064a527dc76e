#pragma once
// The light of a facet lobe from the rays of the pixels about it.
//
// Each ray stands for the place it has met. A lobe weighs it by its own reflection towards that place over the density with which
// the ray was drawn, and takes the mean (ratio estimator of ray reuse: Stachowiak & Uludag, Stochastic Screen-Space Reflections,
// SIGGRAPH 2015 courses). Directions follow a pattern of 8 x 8 pixels (kGlossyPattern_px), of which each window of that size has
// every one once, wherever it lies (interleaved sampling: Keller & Heidrich, EGWR 2001).
//
// Left out: that something may stand between a lobe and what its neighbour's ray has met.

#include <cstdint>

#include "render/glossy/glossy_buffer.h"

namespace hilcam {

inline constexpr int kGlossyPattern_px = 8;

// Returns how far off pixels are whose rays serve a lobe with so many of its own: about a hundred rays are enough, and those of pixels
// further off tell less.
inline int glossy_reach_px(int rays) { return rays < 4 ? kGlossyPattern_px : kGlossyPattern_px / 2; }
// The numbers in [0, 1) that choose the direction of a pixel's ray, by its number among `rays`. The rays of any 8 x 8 pixels that have
// one each, or of any 4 x 4 that have four, lie in 64 different squares, and each coordinate in 64 different strips (correlated
// multi-jittered: Kensler, Pixar Technical Memo 13-01, 2013).
struct GlossyPlace {
    float u1, u2;
};
GlossyPlace glossy_place(int x, int y, int ray, int rays);

// Light that a lobe sends to its pixel: radiance, times its samples.
struct GlossyLight {
    Spectrum surfaces, bodies;
};
// x, y: the pixel of the point. Loop, any thread.
GlossyLight reused_light(const GlossyBuffer& buffer, const GlossyPoint& at, int x, int y);

}  // namespace hilcam
