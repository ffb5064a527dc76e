#pragma once
// Random numbers of a pixel: the number of its electrons, and a normal deviate for its read noise.
//
// Shot noise is Poisson: by exact inversion for means below 32 e-; above, by a normal deviate with the
// Cornish-Fisher term for skewness (Cornish & Fisher, Rev. Inst. Int. Stat. 5, 1938), rounded; the mean is
// right to 1e-3 e-, the variance to 0.3 %. Uniform deviates have 23 bits, so tails end at 5.2 standard
// deviations. Every deviate is a function of (seed, frame, pixel): any pixel can be recomputed alone, with
// any number of threads.

#include <cstdint>
#include <span>

#include "render/vocabulary/random.h"

namespace hilcam {

// Draws for pixels first_pixel, first_pixel + 1, ... the charge, from means of 0 .. 1e9 e- (a NaN counts as
// 0), and independent standard normal deviates. An empty span is not filled. Loop, any thread.
void draw_pixels(std::span<const float> mean_e, RandomKey key, std::uint32_t first_pixel,
                 std::span<float> charge_e, std::span<float> deviates);

// Draws standard normal deviates of a stream: number first, first + 1, and so on. Loop, any thread.
void draw_normals(RandomKey key, RandomPurpose purpose, std::uint32_t index, std::uint64_t first,
                  std::span<float> deviates);

// Returns the standard normal quantile of u in (0, 1) in single precision, relative error below 1e-5: Giles,
// "Approximating the erfinv function", GPU Computing Gems Jade Edition, 2012.
float normal_quantile(float u);

// Returns a Poisson number from a uniform number in (0, 1): by inversion; for means above 500, as
// draw_pixels() does.
std::uint32_t poisson_count(double mean, double uniform);

}  // namespace hilcam
