#include "sensor/zernike.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "render/vocabulary/units.h"
#include "sensor/convolution/fourier.h"

namespace hilcam {
namespace {

constexpr int kPupilAcross = 256;  // samples across the pupil's diameter
// Size of the grid; the autocorrelation is twice as wide as the pupil.
constexpr int kSize = 2 * kPupilAcross;
constexpr double kStep = 2.0 / kPupilAcross;  // pupil radii per sample

struct Order {
    int n, m;  // m < 0: sine
};

// Row n has n + 1 terms, with |m| rising; even j have the cosine.
Order order_of(int noll) {
    int n = 0, first = 1;
    while (first + n + 1 <= noll) first += ++n;
    int m = n % 2;
    for (int j = first; j < noll;) {
        const int terms = m == 0 ? 1 : 2;
        if (noll < j + terms) break;
        j += terms;
        m += 2;
    }
    return {n, noll % 2 == 0 ? m : -m};
}

double factorial(int k) { return k < 2 ? 1 : k * factorial(k - 1); }

double radial(int n, int m, double rho) {
    double sum = 0;
    for (int s = 0; s <= (n - m) / 2; ++s)
        sum += (s % 2 ? -1.0 : 1.0) * factorial(n - s) /
               (factorial(s) * factorial((n + m) / 2 - s) * factorial((n - m) / 2 - s)) *
               std::pow(rho, n - 2 * s);
    return sum;
}

// Returns the share of a sample's square inside the annulus.
double cover(double x, double y, double obscuration_ratio) {
    constexpr int kParts = 4;
    int inside = 0;
    for (int j = 0; j < kParts; ++j)
        for (int i = 0; i < kParts; ++i) {
            const double r =
                std::hypot(x + ((i + 0.5) / kParts - 0.5) * kStep, y + ((j + 0.5) / kParts - 0.5) * kStep);
            inside += r <= 1 && r >= obscuration_ratio ? 1 : 0;
        }
    return inside / static_cast<double>(kParts * kParts);
}

}  // namespace

double zernike(int noll, double x, double y) {
    const auto [n, m] = order_of(noll);
    const double value = std::sqrt(n + 1.0) * radial(n, std::abs(m), std::hypot(x, y));
    if (m == 0) return value;
    const double angle = std::abs(m) * std::atan2(y, x);
    return value * std::sqrt(2.0) * (m > 0 ? std::cos(angle) : std::sin(angle));
}

PupilTransfer::PupilTransfer(double obscuration_ratio, double defocus_waves, std::span<const double> waves)
    : otf_(std::size_t{kSize} * kSize) {
    double area = 0;
    for (int j = 0; j < kPupilAcross; ++j)
        for (int i = 0; i < kPupilAcross; ++i) {
            const double x = (i + 0.5) * kStep - 1, y = (j + 0.5) * kStep - 1;
            const double amplitude = cover(x, y, obscuration_ratio);
            if (amplitude == 0) continue;
            double phase = defocus_waves * (x * x + y * y);
            for (std::size_t k = 0; k < waves.size(); ++k)
                phase += waves[k] * zernike(static_cast<int>(k) + 4, x, y);
            otf_[static_cast<std::size_t>(j) * kSize + static_cast<std::size_t>(i)] =
                std::complex<float>(std::polar(amplitude, 2 * kPi * phase));
            area += amplitude;
        }
    // Autocorrelation: transform, squared modulus, transform.
    fourier_forward(otf_, kSize);
    const auto scale = static_cast<float>(1 / (area * kSize * kSize));
    for (auto& value : otf_) value = std::norm(value) * scale;
    fourier_forward(otf_, kSize);
    // A sample on the pupil's edge overlaps itself with the square of its share, which is right for every
    // shift except zero.
    otf_[0] = 1;
}

std::complex<double> PupilTransfer::at(double shift_x, double shift_y) const {
    if (std::hypot(shift_x, shift_y) >= 2) return 0;
    const double x = shift_x / kStep, y = shift_y / kStep;
    const double left = std::floor(x), top = std::floor(y);
    const auto sample = [&](double i, double j) {
        const auto wrap = [](double k) {
            return static_cast<std::size_t>((static_cast<int>(k) + kSize) % kSize);
        };
        return std::complex<double>(otf_[wrap(j) * kSize + wrap(i)]);
    };
    const double u = x - left, v = y - top;
    return (1 - v) * ((1 - u) * sample(left, top) + u * sample(left + 1, top)) +
           v * ((1 - u) * sample(left, top + 1) + u * sample(left + 1, top + 1));
}

}  // namespace hilcam
