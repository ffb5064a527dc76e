#include "sensor/measure/quantiser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// Above this the deviation from mean and variance + 1/12 is below exp(-2 pi^2 1.5^2), 5e-20.
constexpr double kWide_dn = 1.5;
constexpr std::size_t kPhases = 64;  // places of a mean between two whole numbers

double below(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

// The share of the pixels whose means are at each place between two whole numbers.
using Phases = std::array<double, kPhases>;

Phases phases_of(std::span<const double> mean_dn, const PixelSelection& selection) {
    Phases share{};
    const auto pixels = static_cast<double>(selection.count());
    HILCAM_CHECK(pixels > 0);
    for (std::size_t i = 0; i < mean_dn.size(); ++i) {
        if (!selection.use[i]) continue;
        const double place = mean_dn[i] - std::floor(mean_dn[i]);
        share[std::min(static_cast<std::size_t>(place * kPhases), kPhases - 1)] += 1 / pixels;
    }
    return share;
}

// Returns the mean variance after rounding, given the phases of the means after rounding.
double variance_after(const Phases& share, double sigma_dn) {
    if (sigma_dn > kWide_dn) return sigma_dn * sigma_dn + 1.0 / 12;
    // The mean after rounding rises with the mean before it, from 0 at 0 to 1 at 1.
    constexpr std::size_t kSteps = 4 * kPhases;
    std::array<RoundedMoments, kSteps + 1> curve;
    for (std::size_t i = 0; i <= kSteps; ++i)
        curve[i] = rounded_moments(static_cast<double>(i) / kSteps, sigma_dn);
    double sum = 0;
    std::size_t at = 0;
    for (std::size_t phase = 0; phase < kPhases; ++phase) {
        const double mean = (static_cast<double>(phase) + 0.5) / kPhases;
        while (at + 1 < kSteps && curve[at + 1].mean < mean) ++at;
        const RoundedMoments &a = curve[at], &b = curve[at + 1];
        const double part = b.mean > a.mean ? std::clamp((mean - a.mean) / (b.mean - a.mean), 0.0, 1.0) : 0;
        sum += share[phase] * (a.variance + part * (b.variance - a.variance));
    }
    return sum;
}

}  // namespace

RoundedMoments rounded_moments(double mean_dn, double sigma_dn) {
    if (sigma_dn > kWide_dn) return {mean_dn, sigma_dn * sigma_dn + 1.0 / 12};
    const double nearest = std::floor(mean_dn + 0.5);
    if (sigma_dn <= 0) return {nearest, 0};
    const int reach = static_cast<int>(std::ceil(9 * sigma_dn)) + 1;
    double first = 0, second = 0;
    for (int k = -reach; k <= reach; ++k) {
        const double low = (nearest + k - 0.5 - mean_dn) / sigma_dn;
        const double share = below(low + 1 / sigma_dn) - below(low);
        first += share * k, second += share * k * k;
    }
    return {nearest + first, second - first * first};
}

double variance_before_rounding_dn2(std::span<const double> mean_dn, const PixelSelection& selection,
                                    double variance_dn2) {
    HILCAM_CHECK(mean_dn.size() == selection.use.size());
    if (variance_dn2 > kWide_dn * kWide_dn + 1.0 / 12) return variance_dn2 - 1.0 / 12;
    const Phases share = phases_of(mean_dn, selection);
    double least = 0.02, most = 2 * kWide_dn;
    if (variance_after(share, least) >= variance_dn2) return 0;
    for (int step = 0; step < 50; ++step) {
        const double middle = 0.5 * (least + most);
        (variance_after(share, middle) < variance_dn2 ? least : most) = middle;
    }
    return least * least;
}

}  // namespace hilcam
