#pragma once
// A sensor's own maps from stacks of its frames: offset and dark signal of each pixel, and its gain. Every
// map is a sum of the stacks' mean pictures with fixed weights, so its random error is known exactly.
//
// Model: a dark pixel has offset + rate x exposure; a lit one adds gain x light. Maps are in DN, DN/s and,
// for the gain, as deviations from the mean of 1.

#include <span>
#include <vector>

#include "sensor/measure/frame_statistics.h"

namespace hilcam {

// Weights with which a straight line is fitted to the stacks' mean pictures, and the variances that follow
// from those of the means.
struct LineWeights {
    std::vector<double> offset, rate;  // for each stack
    double offset_variance = 0, rate_variance = 0, covariance = 0;
};
// time_s: exposures; variance_dn2: that of a pixel's mean in each stack. HILCAM_CHECK: two different
// exposures.
LineWeights line_weights(std::span<const double> time_s, std::span<const double> variance_dn2);

// The spread of a map: what its pixels, rows and columns differ by, and how much of that is random error.
struct MapSpread {
    SpatialParts measured;            // the map's variances, random errors included
    double noise = 0, row_noise = 0;  // variances of the errors of a pixel, and of a row as a whole
    double pixel() const;             // variance of the pixels themselves, at least 0
    // Returns the correlation that is to be expected between the map and the pixels' true values.
    double correlation() const;
};
MapSpread map_spread(std::span<const double> map, const PixelSelection& selection, double noise,
                     double row_noise);

// Returns the map with deviations of pixels, rows and columns made smaller, so that their spreads are the
// true ones: random errors widen a measured map, and a camera made from it would be too uneven. The
// correlation with the true map stays the same. Pixels that do not count (defects) keep their values.
std::vector<double> with_true_spread(std::span<const double> map, const PixelSelection& selection,
                                     const MapSpread& spread);

// A pixel that changes between two states (random telegraph noise), from its values in a series of dark
// frames: a mixture of two Gaussians of known and equal width, fitted by expectation maximisation (Dempster,
// Laird & Rubin, J. Roy. Statist. Soc. B 39, 1977).
struct TwoStates {
    double low_dn = 0, high_dn = 0;
    double uncertainty_dn = 0;  // one standard deviation of the difference
    int changes = 0;            // number of frames that differ from the one before
};
TwoStates two_states(std::span<const double> value_dn, double sigma_dn);

}  // namespace hilcam
