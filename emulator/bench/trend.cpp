#include "emulator/bench/trend.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/vocabulary/median.h"

namespace hilcam {
namespace {

double terms(double n) { return n * (n - 1) * (2 * n + 5) / 18; }

// Returns the variance of the sum of signs without a trend.
double variance(std::vector<double> values) {
    double out = terms(static_cast<double>(values.size()));
    std::sort(values.begin(), values.end());
    for (auto from = values.begin(); from != values.end();) {
        const auto to = std::upper_bound(from, values.end(), *from);
        out -= terms(static_cast<double>(to - from));
        from = to;
    }
    return out;
}

}  // namespace

Trend trend_of(std::span<const double> values) {
    if (values.size() < 2) return {};
    std::vector<double> slopes;
    slopes.reserve(values.size() * (values.size() - 1) / 2);
    double signs = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
        for (std::size_t j = i + 1; j < values.size(); ++j) {
            slopes.push_back((values[j] - values[i]) / static_cast<double>(j - i));
            signs += slopes.back() > 0 ? 1 : slopes.back() < 0 ? -1 : 0;
        }
    Trend trend{median(slopes), 0};
    // Moves the sum by one towards zero, because it changes in steps of two (Kendall's correction for
    // continuity).
    if (signs != 0)
        trend.sigma =
            (signs - std::copysign(1.0, signs)) / std::sqrt(variance({values.begin(), values.end()}));
    return trend;
}

}  // namespace hilcam
