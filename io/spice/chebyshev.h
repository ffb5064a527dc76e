#pragma once
// Sums of Chebyshev polynomials of the first kind, with derivative and integral, by Clenshaw's recurrence
// (Press et al., Numerical Recipes, 3rd ed., 2007, section 5.8). No allocation.

#include <cstddef>
#include <span>

namespace hilcam {

struct ChebyshevValue {
    double value = 0, slope = 0;
};

// Returns sum c_n T_n(s) and its derivative with respect to s, for s in [-1, 1].
inline ChebyshevValue chebyshev_at(std::span<const double> c, double s) {
    // b_n = c_n + 2 s b_(n+1) - b_(n+2), and the same recurrence differentiated.
    double b1 = 0, b2 = 0, d1 = 0, d2 = 0;
    for (std::size_t n = c.size(); n-- > 1;) {
        const double d = 2 * s * d1 - d2 + 2 * b1, b = 2 * s * b1 - b2 + c[n];
        d2 = d1, d1 = d, b2 = b1, b1 = b;
    }
    if (c.empty()) return {};
    return {c[0] + s * b1 - b2, b1 + s * d1 - d2};
}

// Returns the integral of the sum from 0 to s. That of T_n is (T_(n+1) / (n + 1) - T_(n-1) / (n - 1)) / 2 for
// n > 1.
inline double chebyshev_integral(std::span<const double> c, double s) {
    double before = 1, now = s, sum = 0;  // T_(n-1), T_n at s
    // T_n(0) is 1, 0, -1, 0, 1, ...
    const auto at_zero = [](std::size_t n) { return n % 2 == 1 ? 0.0 : n % 4 == 0 ? 1.0 : -1.0; };
    for (std::size_t n = 0; n < c.size(); ++n) {
        if (n == 0) {
            sum += c[0] * s;
            continue;
        }
        const double next = 2 * s * now - before, order = static_cast<double>(n);
        if (n == 1)
            sum += c[1] * s * s / 2;
        else
            sum +=
                c[n] / 2 * ((next - at_zero(n + 1)) / (order + 1) - (before - at_zero(n - 1)) / (order - 1));
        before = now, now = next;
    }
    return sum;
}

}  // namespace hilcam
