#pragma once
// From mean electrons to digital numbers: shot noise, full well, read noise, gain, offset, ADC, in that
// order.
//
// Shot noise: Poisson. Means below 32 e- by exact inversion; above, a normal deviate with the Cornish-Fisher
// term for skewness (Cornish & Fisher, Rev. Inst. Int. Stat. 5, 1938), rounded: mean right to 1e-3 e-,
// variance to 0.3 %. Uniform deviates have 23 bits, so tails end at 5.2 standard deviations. Read noise:
// Gaussian, independent in every pixel and frame. Every deviate is a function of (seed, frame, pixel): any
// pixel can be recomputed alone, on any thread count.

#include <cstdint>
#include <span>

#include "render/random.h"

namespace hilcam {

struct DigitiserParameters {
    float full_well_e = 0;
    float read_noise_e = 0;
    float gain_dn_e = 0;  // with the gain in dB applied
    float offset_dn = 0;
    float most_dn = 0;  // 2^bits - 1
};

// One row. mean_e: 0 .. 1e9, a NaN counts as 0; pixel `first_pixel + i` keys element i. Loop, any thread.
void digitise_row(std::span<const float> mean_e, const DigitiserParameters& parameters, RandomKey key,
                  std::uint32_t first_pixel, std::span<std::uint16_t> dn);

// The standard normal quantile of u in (0, 1), single precision, error below 1e-5 relative: Giles,
// "Approximating the erfinv function", GPU Computing Gems Jade Edition, 2012.
float normal_quantile(float u);

}  // namespace hilcam
