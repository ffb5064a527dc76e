#include "render/vocabulary/spectrum.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {

double Curve::at(double wavelength) const {
    HILCAM_CHECK(!value.empty() && value.size() == wavelength_um.size());
    const auto above = std::upper_bound(wavelength_um.begin(), wavelength_um.end(), wavelength);
    if (above == wavelength_um.begin()) return value.front();
    if (above == wavelength_um.end()) return value.back();
    const auto i = static_cast<std::size_t>(above - wavelength_um.begin());
    const double u = (wavelength - wavelength_um[i - 1]) / (wavelength_um[i] - wavelength_um[i - 1]);
    return value[i - 1] + u * (value[i] - value[i - 1]);
}

double Curve::mean(double from_um, double to_um) const {
    // Between its knots the curve is straight, so the trapezoid of each piece is exact.
    double integral = 0;
    double left = from_um;
    double left_value = at(from_um);
    for (const double knot : wavelength_um) {
        if (knot <= from_um || knot >= to_um) continue;
        const double knot_value = at(knot);
        integral += 0.5 * (left_value + knot_value) * (knot - left);
        left = knot;
        left_value = knot_value;
    }
    integral += 0.5 * (left_value + at(to_um)) * (to_um - left);
    return integral / (to_um - from_um);
}

SpectralGrid::SpectralGrid(std::vector<double> edges_um) : edges_um_(std::move(edges_um)) {
    if (edges_um_.size() < 2 || edges_um_.size() > kMaxBins + 1)
        throw InputError("spectral bins: found " + std::to_string(edges_um_.size()) +
                         " edges; accepted are 2 to " + std::to_string(kMaxBins + 1));
    for (std::size_t i = 0; i < edges_um_.size(); ++i) {
        const bool inside = edges_um_[i] >= kShortest_um && edges_um_[i] <= kLongest_um;
        const bool rising = i == 0 || edges_um_[i] > edges_um_[i - 1];
        if (!inside || !rising)
            throw InputError("spectral bins: edge " + std::to_string(edges_um_[i]) +
                             " um; edges must rise and lie in 0.2 to 20 um");
        if (i > 0 && edges_um_[i - 1] < kThermalFrom_um && edges_um_[i] > kThermalFrom_um)
            throw InputError("spectral bins: the bin from " + std::to_string(edges_um_[i - 1]) + " to " +
                             std::to_string(edges_um_[i]) +
                             " um lies on both sides of 2.5 um, where thermal bins begin; accepted: an edge "
                             "at 2.5");
    }
}

int SpectralGrid::solar_bins() const {
    int count = 0;
    while (count < size() && !is_thermal(count)) ++count;
    return count;
}

Spectrum SpectralGrid::average(const Curve& curve) const {
    Spectrum out;
    for (int b = 0; b < size(); ++b) out[b] = static_cast<float>(curve.mean(from_um(b), to_um(b)));
    return out;
}

namespace {

// The bins up to number `bins` are to be covered.
void require_cover_of(const Curve& curve, const SpectralGrid& grid, int bins, const std::string& what) {
    constexpr double kRounding_um = 1e-9;
    if (curve.wavelength_um.size() < 2 || bins == 0) return;
    const double from = grid.from_um(0), to = grid.to_um(bins - 1);
    if (curve.wavelength_um.front() <= from + kRounding_um && curve.wavelength_um.back() >= to - kRounding_um)
        return;
    const auto text = [](double value) {
        std::string digits = std::to_string(value);
        return digits.substr(0, digits.find('.') + 4);
    };
    throw InputError((curve.where.empty() ? "" : curve.where + ": ") + what + ": the curve reaches from " +
                     text(curve.wavelength_um.front()) + " to " + text(curve.wavelength_um.back()) +
                     " um; the scenario's spectrum_edges_um need " + text(from) + " to " + text(to) + " um");
}

// Returns the share of a black body's radiance below a wavelength; x: h c / (wavelength k T).
double share_below(double x) {
    constexpr double kNegligible = 1e-17;
    double sum = 0;
    for (int n = 1;; ++n) {
        const double term = std::exp(-n * x) * (x * x * x / n + 3 * x * x / (1.0 * n * n) +
                                                6 * x / (1.0 * n * n * n) + 6 / (1.0 * n * n * n * n));
        sum += term;
        if (!(term > kNegligible * sum)) break;
    }
    return 15 / (kPi * kPi * kPi * kPi) * sum;
}

}  // namespace

void require_cover(const Curve& curve, const SpectralGrid& grid, const std::string& what) {
    require_cover_of(curve, grid, grid.size(), what);
}

void require_solar_cover(const Curve& curve, const SpectralGrid& grid, const std::string& what) {
    require_cover_of(curve, grid, grid.solar_bins(), what);
}

double planck_w_m2_sr_um(double wavelength_um, double temperature_k) {
    const double wavelength_m = wavelength_um * 1e-6;
    const double x = kPlanck_j_s * kSpeedOfLight_m_s / (wavelength_m * kBoltzmann_j_k * temperature_k);
    // 2 h c^2 / lambda^5 / (e^x - 1) per metre of wavelength; 1e-6 makes it per um.
    return 2 * kPlanck_j_s * kSpeedOfLight_m_s * kSpeedOfLight_m_s / std::pow(wavelength_m, 5) /
           std::expm1(x) * 1e-6;
}

Spectrum planck_w_m2_sr_um(const SpectralGrid& grid, double temperature_k) {
    Spectrum out;
    if (!(temperature_k > 0)) return out;
    const double x_um = 1e6 * kPlanck_j_s * kSpeedOfLight_m_s / (kBoltzmann_j_k * temperature_k);
    const double all_w_m2_sr = kStefanBoltzmann_w_m2_k4 / kPi * std::pow(temperature_k, 4);
    double below = share_below(x_um / grid.from_um(0));
    for (int b = 0; b < grid.size(); ++b) {
        const double above = share_below(x_um / grid.to_um(b));
        out[b] = static_cast<float>(all_w_m2_sr * (above - below) / grid.width_um(b));
        below = above;
    }
    return out;
}

}  // namespace hilcam
