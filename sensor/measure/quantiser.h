#pragma once
// The exact effect of rounding to whole numbers on a mean and a variance. EMVA 1288 (section 2.4) adds 1/12
// DN^2 for it, which holds when the noise spans the converter's steps: at 0.5 DN of noise the true addition
// is off by up to 0.8 % of a DN^2, at 0.3 DN by more than the noise itself (Widrow, Kollar & Liu, IEEE Trans.
// Instrum. Meas. 45, 1996).

#include <span>

#include "sensor/measure/frame_statistics.h"

namespace hilcam {

struct RoundedMoments {
    double mean = 0, variance = 0;
};
// Returns mean and variance of a Gaussian value after rounding to the nearest whole number.
RoundedMoments rounded_moments(double mean_dn, double sigma_dn);

// Returns the variance before rounding [DN^2] of pixels that have, after it, these means and on average this
// variance; 0 when the noise does not reach the next step. mean_dn: over the selection's rectangle. The
// means' own errors s [DN] blur the effect: a share 2 pi^2 s^2 of the correction is missed.
double variance_before_rounding_dn2(std::span<const double> mean_dn, const PixelSelection& selection,
                                    double variance_dn2);

}  // namespace hilcam
