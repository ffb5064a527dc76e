#pragma once
// Whether a series of figures rises or falls with time, told so that single outliers do not matter.
//
// Slope: the median of the slopes between all pairs (Theil 1950; Sen, J. Am. Stat. Assoc. 63, 1968, 1379).
// Significance: the Mann-Kendall test with the variance for ties (Kendall, Rank Correlation Methods, 1975),
// in standard deviations of its normal approximation, which wants independent figures. Time and memory go as
// the square of the number of figures.

#include <cstddef>
#include <span>

namespace hilcam {

struct Trend {
    double per_step = 0;  // from one figure to the next
    double sigma = 0;     // positive: rises
};
// Of fewer than two figures: none.
Trend trend_of(std::span<const double> values);

// A trend of this much is no chance (2.7 in a thousand, both signs). Fewer figures than kMinForTrend cannot
// reach it, whatever they are.
inline constexpr double kSignificant_sigma = 3;
inline constexpr std::size_t kMinForTrend = 7;

}  // namespace hilcam
