#pragma once
// The renderer knows the sensor behind it by these plain numbers, so that it can weigh its own error against
// that sensor's noise. Radiance L becomes electrons q = sum over bins of electrons_per_radiance L; a pixel of
// q electrons has the variance
//     sigma^2 = dark_variance_e2 + q + (gain_fraction q)^2
// of read-out, photons (Poisson) and unequal pixels (EMVA 1288 release 4.0: dark noise, shot noise, PRNU).

#include <cmath>

#include "render/vocabulary/spectrum.h"

namespace hilcam {

// The noise of one exposure.
struct PixelNoise {
    Spectrum electrons_per_radiance;  // per W m^-2 sr^-1 um^-1 of each bin; 0: not told
    float dark_variance_e2 = 0;       // variance of a pixel without light [e-^2]
    float gain_fraction = 0;          // standard deviation of the pixels' gains over their mean
    // Independent values of radiance that are averaged to one pixel of the detector: its parts, the instants
    // of the exposure. Errors of each may be larger by the root of it.
    float averaged = 1;

    float electrons(const Spectrum& radiance, int bins) const {
        float sum = 0;
        for (int b = 0; b < bins; ++b) sum += electrons_per_radiance[b] * radiance[b];
        return sum;
    }
    float variance_e2(float electrons) const {
        const float unequal_e = gain_fraction * electrons;
        return dark_variance_e2 + electrons + unequal_e * unequal_e;
    }
};

}  // namespace hilcam
