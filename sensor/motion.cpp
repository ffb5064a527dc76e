#include "sensor/motion.h"

#include <cmath>
#include <complex>

#include "render/vocabulary/check.h"
#include "render/vocabulary/random.h"
#include "render/vocabulary/units.h"
#include "sensor/mtf.h"

namespace hilcam {

Fields fields(JitterConfig& c) {
    return {
        numbers("rms_arcsec", c.rms_rad, kArcsecond_rad, {0, 36000}, {2, 2},
                "rms jitter about the camera's x and y axes within one exposure"),
        table("psd", c.psd_arcsec2_hz, {"hz", "arcsec2_hz"}, {1e-6, 1e6}, {0, 1e12},
              "one-sided power spectral density of the jitter about each axis"),
    };
}

void validate(const JitterConfig& c) {
    if (c.psd_arcsec2_hz.x.size() == 1) throw refused("psd", "one sample", "two or more");
}

// --- blur within an exposure

namespace {

constexpr double kArcsecond2_rad2 = kArcsecond_rad * kArcsecond_rad;

// Si(x) and Ci(x) for x >= 2, by the continued fraction of E1(ix) = -Ci(x) + i (Si(x) - pi/2): Abramowitz &
// Stegun, Handbook of Mathematical Functions, 1964, 5.1.22 and 5.2.21-24, evaluated after Lentz (Applied
// Optics 15, 1976).
struct SineCosineIntegrals {
    double si, ci;
};
SineCosineIntegrals sine_cosine_integrals(double x) {
    using Complex = std::complex<double>;
    Complex b{1, x};
    Complex c{1e300, 0};
    Complex d = 1.0 / b;
    Complex h = d;
    for (int i = 1; i < 200; ++i) {
        const double a = -static_cast<double>(i) * i;
        b += 2.0;
        d = 1.0 / (a * d + b);
        c = b + a / c;
        const Complex step = c * d;
        h *= step;
        if (std::abs(step.real() - 1) + std::abs(step.imag()) < 1e-15) break;
    }
    h *= Complex{std::cos(x), -std::sin(x)};
    return {0.5 * kPi + h.imag(), -h.real()};
}

// Integrals, from 0 to x, of 1 - sin^2 t / t^2 and of t times it, for x up to 1: power series of the cosine.
struct Moments {
    double zeroth, first;
};
Moments moments_below_1(double x) {
    Moments sum{0, 0};
    double term = 1;  // (-1)^k 2^(2k-1) x^(2k-2) / (2k)! from k = 2 on
    for (int k = 2; k < 14; ++k) {
        term *= (k == 2 ? 1.0 : -1.0) * 4 * x * x / ((2 * k - 1) * (2 * k));
        sum.zeroth += term * x / (2 * k - 1);
        sum.first += term * x * x / (2 * k);
    }
    return sum;
}
// The same for x above 1: the integral of sin^2 x / x^2 is Si(2x) - sin^2 x / x, that of sin^2 x / x is (ln x
// - Ci(2x)) / 2, with other constants than above.
Moments moments_above_1(double x) {
    const auto [si, ci] = sine_cosine_integrals(2 * x);
    const double sine = std::sin(x);
    return {x - (si - sine * sine / x), 0.5 * x * x - 0.5 * (std::log(x) - ci)};
}

}  // namespace

double jitter_blur_rad2(const JitterConfig& config, double exposure_s) {
    const Table& psd = config.psd_arcsec2_hz;
    if (!(exposure_s > 0)) return 0;
    const double per_hz = kPi * exposure_s;  // x = pi f T
    double sum = 0;
    for (std::size_t i = 1; i < psd.x.size(); ++i) {
        const double slope = (psd.y[i] - psd.y[i - 1]) / (psd.x[i] - psd.x[i - 1]);
        const double at_0 = psd.y[i - 1] - slope * psd.x[i - 1];
        const auto add = [&](Moments from, Moments to) {
            sum += at_0 / per_hz * (to.zeroth - from.zeroth) +
                   slope / (per_hz * per_hz) * (to.first - from.first);
        };
        const double x0 = per_hz * psd.x[i - 1], x1 = per_hz * psd.x[i];
        if (x0 < 1) add(moments_below_1(x0), moments_below_1(std::min(x1, 1.0)));
        if (x1 > 1) add(moments_above_1(std::max(x0, 1.0)), moments_above_1(x1));
    }
    return sum * kArcsecond2_rad2;
}

// --- displacement of exposures

namespace {

// Returns the frequency below which the density has this share of its variance. total: variance of the whole table.
double frequency_of_share(const Table& psd, double total, double share) {
    double left = share * total;
    for (std::size_t i = 1; i < psd.x.size(); ++i) {
        const double width = psd.x[i] - psd.x[i - 1];
        const double a = psd.y[i - 1], b = psd.y[i];
        const double here = 0.5 * (a + b) * width;
        if (left > here && i + 1 < psd.x.size()) {
            left -= here;
            continue;
        }
        // Solves a u + (b - a) u^2 / 2 = left / width in the form without cancellation.
        const double c = std::min(left, here) / width;
        const double root = std::sqrt(std::max(0.0, a * a + 2 * (b - a) * c));
        return psd.x[i - 1] + width * (a + root > 0 ? std::min(1.0, 2 * c / (a + root)) : 0.0);
    }
    return psd.x.back();
}

double total_of(const Table& psd) {
    double total = 0;
    for (std::size_t i = 1; i < psd.x.size(); ++i)
        total += 0.5 * (psd.y[i] + psd.y[i - 1]) * (psd.x[i] - psd.x[i - 1]);
    return total;
}

}  // namespace

PointingJitter::PointingJitter(const JitterConfig& config, std::uint64_t seed, TimeTai start)
    : start_(start) {
    const Table& psd = config.psd_arcsec2_hz;
    const double total = total_of(psd);
    if (!(total > 0)) return;
    const double sigma_rad = kArcsecond_rad * std::sqrt(total / kSinusoids);
    for (std::uint32_t axis = 0; axis < 2; ++axis)
        for (std::uint32_t i = 0; i < kSinusoids; ++i) {
            const auto words = random_words({seed, 0}, RandomPurpose::kPointing, i, axis);
            const auto uniform = [&](std::size_t w) { return static_cast<double>(uniform01(words[w])); };
            // Two Gaussian quadratures with deviation sigma have a Rayleigh amplitude and a uniform phase.
            axes_[axis].push_back({frequency_of_share(psd, total, (i + uniform(0)) / kSinusoids),
                                   sigma_rad * std::sqrt(-2 * std::log(uniform(1))), 2 * kPi * uniform(2)});
        }
}

Vec2d PointingJitter::at(TimeTai middle, double exposure_s) const {
    const double t_s = static_cast<double>(middle - start_) * kSecondsPerNs;
    const auto sum = [&](const std::vector<Sinusoid>& axis) {
        double angle_rad = 0;
        for (const Sinusoid& s : axis)
            angle_rad += s.amplitude_rad * sinc(s.frequency_hz * exposure_s) *
                         std::cos(2 * kPi * s.frequency_hz * t_s + s.phase_rad);
        return angle_rad;
    };
    return {sum(axes_[0]), sum(axes_[1])};
}

Pose PointingJitter::applied(const Pose& camera, TimeTai middle, double exposure_s) const {
    if (axes_[0].empty()) return camera;
    const Vec2d angle_rad = at(middle, exposure_s);
    return {camera.position_world_m,
            normalized(camera.world_from_body * from_rotation_vector({angle_rad.x, angle_rad.y, 0}))};
}

}  // namespace hilcam
