#pragma once
// The part of measure_clone() that is about the dark: offset, noise and its parts, dark current and its
// doubling temperature.

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "emulator/clone/clone_measurement.h"

namespace hilcam {

// Exposures and temperatures that count as the same.
inline constexpr double kSameExposure = 1e-3, kSameTemperature_k = 0.5;
inline bool same_exposure(double a_s, double b_s) {
    return std::abs(a_s - b_s) <= kSameExposure * std::max(a_s, b_s);
}

struct DarknessWork {
    const FrameSet& frames;
    std::size_t brief = 0;  // series of darks with the shortest exposure at the reference temperature
    std::span<const double> brief_mean_dn;   // mean picture of that series
    std::function<double(double)> charge_e;  // charge behind a signal [DN]
};
// Fills offset, noises, dark currents and the doubling temperature. The measurement has its gain and the
// statistics of its darks already.
void measure_darkness(const DarknessWork& work, CloneMeasurement& out);

}  // namespace hilcam
