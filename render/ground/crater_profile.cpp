#include "render/ground/crater_profile.h"

#include <algorithm>
#include <cmath>

namespace hilcam {
namespace {

// Rim height over depth under the rim, of all sizes: 0.036 / 0.196.
constexpr double kRim = 0.036 / 0.196;

// The profile for a depth of 1 below the rim.
double fresh(double x) {
    if (x < 1) return kRim - 1 + x * x;
    const double end = std::pow(CraterProfile::kReach, -3);
    return x < CraterProfile::kReach ? kRim * (1 / (x * x * x) - end) / (1 - end) : 0;
}

// Wear grows with the square, so that young craters have several states.
double worn_of(double state, double states) {
    return CraterProfile::kMaxWorn * (state / states) * (state / states);
}

}  // namespace

double CraterProfile::fresh_depth(double diameter_m) {
    const double km = diameter_m * 1e-3;
    return 0.196 * std::pow(km, 0.010);
}

// Diffusion around an axis, dh/dt = (1/x) d/dx (x dh/dx), by explicit steps within the stability limit, out
// to twice the reach.
CraterProfile::CraterProfile() {
    constexpr int kFar = 2 * kSteps;
    const double dx = kReach / kSteps, dt = 0.2 * dx * dx;
    std::vector<double> h(kFar + 1), next(kFar + 1);
    for (int i = 0; i <= kFar; ++i) h[static_cast<std::size_t>(i)] = fresh(i * dx);
    double t = 0;
    for (int state = 0; state <= kStates; ++state) {
        const double until = worn_of(state, kStates);
        while (t < until) {
            const double step = std::min(dt, until - t) / (dx * dx);
            for (std::size_t i = 0; i < kFar; ++i) {
                const double x = static_cast<double>(i);
                const double flow = i == 0
                                        ? 4 * (h[1] - h[0])
                                        : ((x + 0.5) * (h[i + 1] - h[i]) - (x - 0.5) * (h[i] - h[i - 1])) / x;
                next[i] = h[i] + step * flow;
            }
            next[kFar] = 0;
            h.swap(next);
            t += step * dx * dx;
        }
        // What has moved beyond the reach is dropped.
        std::vector<double>& kept = states_.emplace_back(h.begin(), h.begin() + kSteps + 1);
        const double rest = kept.back();
        for (int i = 0; i <= kSteps; ++i) {
            const double x = i * dx / kReach;
            kept[static_cast<std::size_t>(i)] -= rest * x * x;
        }
    }
}

CraterProfile::Worn CraterProfile::at(double worn) const {
    const double state = kStates * std::sqrt(std::clamp(worn / kMaxWorn, 0.0, 1.0));
    const auto s = std::min(static_cast<std::size_t>(state), static_cast<std::size_t>(kStates - 1));
    return {states_[s].data(), states_[s + 1].data(), state - static_cast<double>(s)};
}

double CraterProfile::height(double distance, double worn) const {
    if (!(distance < kReach)) return 0;
    const Worn shape = at(worn);
    const double x = distance / kReach * kSteps;
    const auto i = std::min(static_cast<std::size_t>(x), static_cast<std::size_t>(kSteps - 1));
    const double t = x - static_cast<double>(i);
    const auto between = [&](const double* state) { return state[i] + t * (state[i + 1] - state[i]); };
    const double fresher = between(shape.fresher);
    return fresher + shape.share * (between(shape.older) - fresher);
}

}  // namespace hilcam
