#include "io/gige/face/register_formula.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hilcam {
namespace {

constexpr double kLargest = 1e300;

double finite(double number) { return std::isnan(number) ? 0 : std::clamp(number, -kLargest, kLargest); }

double between(const std::pair<double, double>& a, const std::pair<double, double>& b, double x) {
    return a.second + (x - a.first) / (b.first - a.first) * (b.second - a.second);
}

// Interpolates in points that rise in `first`; the ends hold beyond them.
double interpolated(const std::vector<std::pair<double, double>>& points, double x) {
    if (x <= points.front().first) return points.front().second;
    if (x >= points.back().first) return points.back().second;
    const auto after = std::upper_bound(points.begin(), points.end(), x,
                                        [](double v, const auto& p) { return v < p.first; });
    return between(*std::prev(after), *after, x);
}

// Interpolates the other way round: numbers rise along the points, values rise or fall.
double inverse(const std::vector<std::pair<double, double>>& points, double value) {
    const bool rises = points.back().second > points.front().second;
    const auto after = std::find_if(points.begin(), points.end(), [&](const auto& p) {
        return rises ? p.second >= value : p.second <= value;
    });
    if (after == points.begin()) return points.front().first;
    if (after == points.end()) return points.back().first;
    const auto &a = *std::prev(after), &b = *after;
    return between({a.second, a.first}, {b.second, b.first}, value);
}

}  // namespace

double RegisterFormula::value(double raw) const {
    switch (kind) {
        case Kind::kLinear:
            return finite(scale * raw + offset);
        case Kind::kReciprocal:
            return finite(raw == 0 ? std::copysign(kLargest, scale) : scale / raw + offset);
        case Kind::kLogarithm:
            return finite(scale * std::log(std::max(raw, 1e-300)) + offset);
        case Kind::kPoints:
            return interpolated(points, raw);
    }
    return 0;
}

double RegisterFormula::raw(double value) const {
    if (kind == Kind::kPoints) return inverse(points, value);
    const double y = (value - offset) / scale;
    switch (kind) {
        case Kind::kReciprocal:
            return finite(y == 0 ? kLargest : 1 / y);
        case Kind::kLogarithm:
            return finite(std::exp(std::min(y, 690.0)));
        default:
            return finite(y);
    }
}

}  // namespace hilcam
