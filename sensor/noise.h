#pragma once
// The chance in a pixel: how many electrons come, and a normal deviate for the noise of its reading.
//
// Shot noise: Poisson. Means below 32 e- by exact inversion; above, a normal deviate with the Cornish-Fisher
// term for skewness (Cornish & Fisher, Rev. Inst. Int. Stat. 5, 1938), rounded: mean right to 1e-3 e-,
// variance to 0.3 %. Uniform deviates have 23 bits, so tails end at 5.2 standard deviations. Every deviate is
// a function of (seed, frame, pixel): any pixel can be recomputed alone, on any thread count.

#include <cstdint>
#include <span>

#include "render/vocabulary/random.h"

namespace hilcam {

// Draws, for pixels first_pixel, first_pixel + 1, ..., the charge that a mean (0 .. 1e9 e-; a NaN counts as
// 0) becomes, and independent standard normal deviates. An empty span: not wanted. Loop, any thread.
void draw_pixels(std::span<const float> mean_e, RandomKey key, std::uint32_t first_pixel,
                 std::span<float> charge_e, std::span<float> deviates);

// Standard normal deviates number first, first + 1, ... of a stream. Loop, any thread.
void draw_normals(RandomKey key, RandomPurpose purpose, std::uint32_t index, std::uint64_t first,
                  std::span<float> deviates);

// The standard normal quantile of u in (0, 1), single precision, error below 1e-5 relative: Giles,
// "Approximating the erfinv function", GPU Computing Gems Jade Edition, 2012.
float normal_quantile(float u);

// A Poisson number of events from a uniform number in (0, 1): by inversion, above 500 as draw_pixels does it.
std::uint32_t poisson_count(double mean, double uniform);

}  // namespace hilcam
