#include "render/earth/phase_function.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Adds |S1|^2 + |S2|^2 of a sphere of size parameter x to each angle (Bohren & Huffman 1983, eqs. 4.74, 4.88
// and appendix A); the refractive index is real.
void add_sphere(double x, double n, double weight, const std::vector<double>& cosines,
                std::vector<double>& sums) {
    const auto terms = static_cast<std::size_t>(x + 4 * std::cbrt(x) + 2);
    const double y = n * x;
    const std::size_t start = static_cast<std::size_t>(std::max(static_cast<double>(terms), y)) + 16;
    std::vector<double> derivative(start +
                                   1);  // derivative of the logarithm of psi_n(y), by downward recurrence
    for (std::size_t k = start; k > 0; --k) {
        const double r = static_cast<double>(k) / y;
        derivative[k - 1] = r - 1 / (derivative[k] + r);
    }
    std::vector<std::complex<double>> a(terms + 1), b(terms + 1);
    double psi0 = std::cos(x), psi1 = std::sin(x), chi0 = -std::sin(x), chi1 = std::cos(x);
    for (std::size_t k = 1; k <= terms; ++k) {
        const double m = static_cast<double>(k), factor = (2 * m - 1) / x;
        const double psi = factor * psi1 - psi0, chi = factor * chi1 - chi0;
        const std::complex<double> xi(psi, -chi), xi1(psi1, -chi1);
        const double da = derivative[k] / n + m / x, db = n * derivative[k] + m / x;
        const double scale = (2 * m + 1) / (m * (m + 1));
        a[k] = scale * (da * psi - psi1) / (da * xi - xi1);
        b[k] = scale * (db * psi - psi1) / (db * xi - xi1);
        psi0 = psi1, psi1 = psi, chi0 = chi1, chi1 = chi;
    }
    for (std::size_t j = 0; j < cosines.size(); ++j) {
        std::complex<double> s1, s2;
        double pi0 = 0, pi1 = 1;
        for (std::size_t k = 1; k <= terms; ++k) {
            const double m = static_cast<double>(k);
            const double tau = m * cosines[j] * pi1 - (m + 1) * pi0;
            s1 += a[k] * pi1 + b[k] * tau;
            s2 += a[k] * tau + b[k] * pi1;
            const double next = ((2 * m + 1) * cosines[j] * pi1 - (m + 1) * pi0) / m;
            pi0 = pi1, pi1 = next;
        }
        sums[j] += weight * (std::norm(s1) + std::norm(s2));
    }
}

}  // namespace

double water_index(double wavelength_um) {
    static const Curve curve{
        {0.35, 0.40, 0.45, 0.50, 0.55, 0.60, 0.65, 0.70, 0.75, 0.80, 0.85, 0.90, 0.95, 1.00},
        {1.343, 1.339, 1.337, 1.335, 1.333, 1.332, 1.331, 1.331, 1.330, 1.329, 1.329, 1.328, 1.327, 1.327},
        {}};
    return curve.at(wavelength_um);
}

// Steps of a tenth of a degree within 5 degrees of both ends, of 170 / 260 degrees in between.
double PhaseFunction::angle_rad(int i) {
    const double degrees =
        i <= 50 ? 0.1 * i : (i >= 310 ? 180 - 0.1 * (360 - i) : 5 + (i - 50) * 170.0 / 260);
    return degrees * kDegree_rad;
}
float PhaseFunction::place(float theta_rad) {
    const float d = theta_rad * static_cast<float>(1 / kDegree_rad);
    const float at = d < 5 ? 10 * d : (d > 175 ? 360 - 10 * (180 - d) : 50 + (d - 5) * (260.0f / 170));
    return std::clamp(at, 0.0f, static_cast<float>(kAngles - 1));
}

PhaseFunction::PhaseFunction(std::vector<double> values) : value_(std::move(values)) {
    const double mean = moments(1)[0];
    for (double& v : value_) v /= mean;
}

PhaseFunction PhaseFunction::henyey_greenstein(double g) {
    std::vector<double> values(kAngles);
    for (int i = 0; i < kAngles; ++i)
        values[static_cast<std::size_t>(i)] =
            (1 - g * g) / std::pow(1 + g * g - 2 * g * std::cos(angle_rad(i)), 1.5);
    return PhaseFunction(std::move(values));
}

PhaseFunction PhaseFunction::droplets(double wavelength_um, double width_um, double n,
                                      double effective_radius_um, double effective_variance) {
    std::vector<double> cosines(kAngles), sums(kAngles);
    for (int i = 0; i < kAngles; ++i) cosines[static_cast<std::size_t>(i)] = std::cos(angle_rad(i));
    // r^((1 - 3b) / b) e^(-r / ab). With this many sizes the ripples of single spheres average out; with 90,
    // 4 to 16 % remained in the backward direction.
    constexpr int kSizes = 150;
    const double a = effective_radius_um, b = effective_variance, most = a * (1 + 5 * std::sqrt(b)),
                 least = 0.12 * a;
    for (int i = 0; i < kSizes; ++i) {
        const double r = least + (i + 0.5) * (most - least) / kSizes;
        const double count = std::exp((1 - 3 * b) / b * std::log(r / a) - (r - a) / (a * b));
        // Wavelengths by the golden section, which fills the bin evenly and gives neighbouring sizes very
        // different ones.
        constexpr double kGolden = 0.6180339887498949;
        const double um = wavelength_um + width_um * (std::fmod(i * kGolden, 1.0) - 0.5);
        add_sphere(2 * kPi * r / um, n, count * um * um, cosines, sums);
    }
    return PhaseFunction(std::move(sums));
}

float PhaseFunction::at(float theta_rad) const {
    const float x = place(theta_rad);
    const auto i = std::min(static_cast<std::size_t>(x), value_.size() - 2);
    const double f = static_cast<double>(x) - static_cast<double>(i);
    return static_cast<float>(value_[i] + f * (value_[i + 1] - value_[i]));
}

std::vector<double> PhaseFunction::moments(std::size_t count) const {
    std::vector<double> sums(count);
    // Two-point Gauss-Legendre over the angle in each step.
    constexpr double kGauss = 0.57735026918962576;
    for (int i = 0; i + 1 < kAngles; ++i)
        for (const double t : {0.5 - 0.5 * kGauss, 0.5 + 0.5 * kGauss}) {
            const double from = angle_rad(i), step = angle_rad(i + 1) - from, theta = from + t * step;
            const auto k = static_cast<std::size_t>(i);
            const double weight =
                0.25 * step * std::sin(theta) * (value_[k] + t * (value_[k + 1] - value_[k]));
            const double mu = std::cos(theta);
            double p0 = 1, p1 = mu;
            for (std::size_t l = 0; l < count; ++l) {
                sums[l] += weight * p0;
                const double m = static_cast<double>(l) + 1;
                const double next = ((2 * m + 1) * mu * p1 - m * p0) / (m + 1);
                p0 = p1, p1 = next;
            }
        }
    return sums;
}

}  // namespace hilcam
