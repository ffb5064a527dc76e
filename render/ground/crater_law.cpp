#include "render/ground/crater_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hilcam {
namespace {

// log10 of the number per km^2 and Ga of diameters above one, by powers of log10 of the diameter in km.
constexpr std::array<double, 12> kNeukum = {-3.0876,  -3.557528, 0.781027,  1.021521,  -0.156012, -0.444058,
                                            0.019977, 0.086850,  -0.005874, -0.006809, 8.25e-4,   5.54e-5};
constexpr double kMin_km = 0.01, kMax_km = 300, kKm2_m2 = 1e6;

double log_neukum(double log_km) {
    double sum = 0;
    for (auto a = kNeukum.rbegin(); a != kNeukum.rend(); ++a) sum = sum * log_km + *a;
    return sum;
}

}  // namespace

double neukum_per_m2(double diameter_m) {
    const double log_km = std::log10(diameter_m * 1e-3), least = std::log10(kMin_km);
    if (log_km >= least) return std::pow(10, log_neukum(std::min(log_km, std::log10(kMax_km)))) / kKm2_m2;
    constexpr double kStep = 1e-4;
    const double slope = (log_neukum(least + kStep) - log_neukum(least)) / kStep;
    return std::pow(10, log_neukum(least) + slope * (log_km - least)) / kKm2_m2;
}

double neukum_age_factor(double age_ga) {
    const auto number = [](double t) { return 5.44e-14 * (std::exp(6.93 * t) - 1) + 8.38e-4 * t; };
    return number(age_ga) / number(1);
}

double equilibrium_per_m2(double diameter_m) { return std::pow(10, -1.1) / (diameter_m * diameter_m); }

CraterLaw::CraterLaw(double age_ga, double smallest_m, double largest_m)
    : age_factor_(neukum_age_factor(age_ga)) {
    constexpr double kPerDecade = 64;
    const double first = std::log10(smallest_m), last = std::log10(largest_m);
    const int steps = std::max(1, static_cast<int>(std::ceil((last - first) * kPerDecade)));
    double most = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= steps; ++i) {
        const double log_d = first + (last - first) * i / steps, d = std::pow(10, log_d);
        // A cumulative number cannot increase with diameter.
        most = std::min(most, std::min(age_factor_ * neukum_per_m2(d), equilibrium_per_m2(d)));
        log_diameter_.push_back(log_d);
        log_number_.push_back(std::log10(most));
    }
}

double CraterLaw::per_m2(double diameter_m) const {
    const double x = std::log10(diameter_m);
    if (x <= log_diameter_.front()) return std::pow(10, log_number_.front());
    if (x >= log_diameter_.back()) return std::pow(10, log_number_.back());
    const auto i = static_cast<std::size_t>(std::upper_bound(log_diameter_.begin(), log_diameter_.end(), x) -
                                            log_diameter_.begin());
    const double t = (x - log_diameter_[i - 1]) / (log_diameter_[i] - log_diameter_[i - 1]);
    return std::pow(10, log_number_[i - 1] + t * (log_number_[i] - log_number_[i - 1]));
}

double CraterLaw::diameter_m(double per_m2) const {
    const double y = std::log10(per_m2);
    if (y >= log_number_.front()) return std::pow(10, log_diameter_.front());
    if (y <= log_number_.back()) return std::pow(10, log_diameter_.back());
    const auto i = static_cast<std::size_t>(
        std::upper_bound(log_number_.begin(), log_number_.end(), y, std::greater<>()) - log_number_.begin());
    const double fall = log_number_[i - 1] - log_number_[i];
    const double t = fall > 0 ? (log_number_[i - 1] - y) / fall : 0;
    return std::pow(10, log_diameter_[i - 1] + t * (log_diameter_[i] - log_diameter_[i - 1]));
}

}  // namespace hilcam
