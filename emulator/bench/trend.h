#pragma once
// Finds whether a series of values rises or falls with time. Single outliers do not affect the result.
//
// Slope: the median of the slopes between all pairs (Theil 1950; Sen, J. Am. Stat. Assoc. 63, 1968, 1379).
//  Significance: the Mann-Kendall test with the variance for ties (Kendall, Rank Correlation Methods, 1975),
//  in standard deviations of its normal approximation, which assumes independent values.
//  Time and memory grow with the square of the number of values.

#include <cstddef>
#include <span>

namespace hilcam {

struct Trend {
    double per_step = 0;  // slope, from one value to the next
    double sigma = 0;     // significance; positive when values rise
};
// Returns no trend for fewer than two figures.
Trend trend_of(std::span<const double> values);

// A trend of at least this much is significant (probability 2.7 in a thousand by chance, both signs
// together). Fewer values than kMinForTrend can never reach it.
inline constexpr double kSignificant_sigma = 3;
inline constexpr std::size_t kMinForTrend = 7;

}  // namespace hilcam
