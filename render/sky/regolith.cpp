#include "render/sky/regolith.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// The grid of Hayne et al. 2017, A3: ten layers in a skin depth, each a fifth thicker than the one above, down
// to twenty skin depths.
constexpr double kLayersInSkinDepth = 10, kGrowth = 0.2, kSkinDepths = 20;
constexpr int kStepsADay = 480;  // at least; an hour and a half
constexpr int kMostDays = 200;
constexpr double kSettled_k = 1e-3;  // from one day to the next, at any time of the day
constexpr double kDaysReach = 5;     // skin depths; the day's wave is then below a hundredth of the surface's

double cube(double x) { return x * x * x; }

// A column of regolith. Nodes are at the surface and between layers; each has the heat of the half layers on
// its two sides.
class Column {
  public:
    Column(const Regolith& regolith, double mean_k) : r_(regolith) {
        const double kappa = r_.contact_w_m_k(0) * (1 + r_.radiative * cube(mean_k / 350)) /
                             (r_.density_kg_m3(0) * Regolith::heat_capacity_j_kg_k(mean_k));
        skin_m_ = std::sqrt(kappa * r_.day_s / kPi);
        depth_m_.push_back(0);
        for (double thick_m = skin_m_ / kLayersInSkinDepth; depth_m_.back() < kSkinDepths * skin_m_;
             thick_m *= 1 + kGrowth)
            depth_m_.push_back(depth_m_.back() + thick_m);
        kelvin_.assign(depth_m_.size(), mean_k);
        for (std::size_t i = 0; i < depth_m_.size(); ++i) {
            const double above_m = i == 0 ? 0 : 0.5 * (depth_m_[i] - depth_m_[i - 1]);
            const double below_m = i + 1 == depth_m_.size() ? 0 : 0.5 * (depth_m_[i + 1] - depth_m_[i]);
            mass_kg_m2_.push_back((above_m + below_m) * r_.density_kg_m3(depth_m_[i]));
            if (below_m > 0)
                contact_w_m2_k_.push_back(r_.contact_w_m_k(depth_m_[i] + below_m) / (2 * below_m));
        }
        for (auto* line : {&lower_, &middle_, &upper_, &right_, &before_, &day_sum_})
            line->resize(depth_m_.size());
    }

    double surface_k() const { return kelvin_[0]; }
    // Ends a day. Below the depth that feels the day, the heat from below flows evenly, so years of warming through
    // are skipped: each node there gets the mean temperature of the node above, and what drives that heat.
    void settle_depth() {
        for (double& sum : day_sum_) sum /= steps_;
        for (std::size_t i = 1; i < kelvin_.size(); ++i)
            if (depth_m_[i - 1] > kDaysReach * skin_m_) {
                const double above_k = day_sum_[i - 1];
                day_sum_[i] = above_k + r_.inner_heat_w_m2 / (contact_w_m2_k_[i - 1] *
                                                              (1 + r_.radiative * cube(above_k / 350)));
                kelvin_[i] = day_sum_[i];
            }
        std::fill(day_sum_.begin(), day_sum_.end(), 0.0);
        steps_ = 0;
    }

    // Goes on by dt with so much light absorbed at its end: backward Euler, twice for the conductivity and the
    // emission that belong to the new temperatures.
    void step(double dt_s, double absorbed_w_m2) {
        before_ = kelvin_;
        for (int round = 0; round < 2; ++round) {
            set_up(dt_s, absorbed_w_m2);
            solve();
        }
        for (std::size_t i = 0; i < kelvin_.size(); ++i) day_sum_[i] += kelvin_[i];
        ++steps_;
    }

  private:
    double flow_w_m2_k(std::size_t i) const {  // between nodes i and i + 1
        return contact_w_m2_k_[i] * (1 + r_.radiative * cube(0.5 * (kelvin_[i] + kelvin_[i + 1]) / 350));
    }
    void set_up(double dt_s, double absorbed_w_m2) {
        const std::size_t n = kelvin_.size();
        for (std::size_t i = 0; i < n; ++i) {
            const double held = mass_kg_m2_[i] * Regolith::heat_capacity_j_kg_k(kelvin_[i]) / dt_s;
            const double up = i == 0 ? 0 : -lower_[i];
            const double down = i + 1 == n ? 0 : flow_w_m2_k(i);
            middle_[i] = held + up + down;
            upper_[i] = -down;
            if (i + 1 < n) lower_[i + 1] = -down;
            right_[i] = held * before_[i];
        }
        // eps sigma T^4 about the present temperature (Newton).
        const double emitted = r_.emissivity * kStefanBoltzmann_w_m2_k4 * cube(kelvin_[0]);
        middle_[0] += 4 * emitted;
        right_[0] += absorbed_w_m2 + 3 * emitted * kelvin_[0];
        right_[n - 1] += r_.inner_heat_w_m2;
    }
    void solve() {  // Thomas' algorithm
        const std::size_t n = kelvin_.size();
        for (std::size_t i = 1; i < n; ++i) {
            const double factor = lower_[i] / middle_[i - 1];
            middle_[i] -= factor * upper_[i - 1];
            right_[i] -= factor * right_[i - 1];
        }
        kelvin_[n - 1] = right_[n - 1] / middle_[n - 1];
        for (std::size_t i = n - 1; i-- > 0;)
            kelvin_[i] = (right_[i] - upper_[i] * kelvin_[i + 1]) / middle_[i];
        for (double& kelvin : kelvin_) kelvin = std::max(kelvin, 2.0);
    }

    const Regolith& r_;
    double skin_m_ = 0;
    int steps_ = 0;  // since the day began
    std::vector<double> depth_m_, mass_kg_m2_, contact_w_m2_k_, kelvin_, day_sum_, before_, lower_, middle_,
        upper_, right_;
};

}  // namespace

double Regolith::contact_w_m_k(double depth_m) const {
    return deep_conductivity_w_m_k -
           (deep_conductivity_w_m_k - surface_conductivity_w_m_k) * std::exp(-depth_m / h_m);
}

double Regolith::density_kg_m3(double depth_m) const {
    return deep_density_kg_m3 - (deep_density_kg_m3 - surface_density_kg_m3) * std::exp(-depth_m / h_m);
}

// Hemingway et al. 1981 and Ledlow et al. 1992, as the paper's table A1 has them.
double Regolith::heat_capacity_j_kg_k(double t) {
    return std::max(0.1, -3.6125 + t * (2.7431 + t * (2.3616e-3 + t * (-1.2340e-5 + t * 8.9093e-9))));
}

double Regolith::reflected(double mu0) const {
    const double zenith = std::acos(std::clamp(mu0, 0.0, 1.0));
    return std::min(
        1.0, albedo + albedo_45 * cube(zenith / (kPi / 4)) + albedo_90 * std::pow(zenith / (kPi / 2), 8));
}

std::vector<double> regolith_day_k(const Regolith& r, double latitude_rad, int count) {
    HILCAM_CHECK(count >= 24 && count <= 100000 && count % 24 == 0);
    const int every = (kStepsADay + count - 1) / count, steps = every * count;
    std::vector<double> absorbed(static_cast<std::size_t>(steps));
    double mean = 0;
    for (int i = 0; i < steps; ++i) {
        const double mu0 = std::cos(latitude_rad) * std::cos(2 * kPi * i / steps);
        const double here = mu0 > 0 ? (1 - r.reflected(mu0)) * mu0 * r.sun_w_m2 : 0;
        absorbed[static_cast<std::size_t>(i)] = here;
        mean += here / steps;
    }
    const double even_k =
        std::pow((mean + r.inner_heat_w_m2) / (r.emissivity * kStefanBoltzmann_w_m2_k4), 0.25);
    // The mean of a day with heat and cold is lower than that of an even one.
    Column column(r, mean > 0 ? 0.8 * even_k : even_k);
    std::vector<double> day(static_cast<std::size_t>(count)), last(day.size(), 0);
    for (int d = 0; d < kMostDays; ++d) {
        for (int i = 0; i < steps; ++i) {
            column.step(r.day_s / steps, absorbed[static_cast<std::size_t>(i)]);
            if (i % every == 0) day[static_cast<std::size_t>(i / every)] = column.surface_k();
        }
        double change = 0;
        for (std::size_t i = 0; i < day.size(); ++i) change = std::max(change, std::abs(day[i] - last[i]));
        if (change < kSettled_k) break;
        last = day;
        column.settle_depth();
    }
    return day;
}

}  // namespace hilcam
