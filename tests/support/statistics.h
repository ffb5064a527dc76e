#pragma once
// Statistics that tests decide by.

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace hilcam {

// Standard normal distribution.
inline double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

// Greatest distance between the distribution of samples and a given one, times sqrt n: Kolmogorov's
// statistic. For a right model it stays below 1.95 in 999 of 1000 cases (Smirnov, Ann. Math. Statist. 19,
// 279, 1948).
template <class Cdf>
double kolmogorov(std::vector<double> samples, const Cdf& cdf) {
    std::sort(samples.begin(), samples.end());
    const double n = static_cast<double>(samples.size());
    double most = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double model = cdf(samples[i]);
        most = std::max({most, std::abs(static_cast<double>(i) / n - model),
                         std::abs((static_cast<double>(i) + 1) / n - model)});
    }
    return most * std::sqrt(n);
}
inline constexpr double kKolmogorov_1_in_1000 = 1.95;

struct Moments {
    double mean = 0, variance = 0;
};
template <class Samples>
Moments moments_of(const Samples& samples) {
    double sum = 0;
    for (const auto s : samples) sum += static_cast<double>(s);
    const double n = static_cast<double>(std::size(samples)), mean = sum / n;
    double squares = 0;
    for (const auto s : samples) squares += (static_cast<double>(s) - mean) * (static_cast<double>(s) - mean);
    return {mean, squares / (n - 1)};
}

}  // namespace hilcam
