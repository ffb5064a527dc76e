#pragma once
// Distortion as a polynomial in both coordinates of the image plane, for lenses that Brown's terms cannot
// describe: an off-axis telescope, or a table of places from a lens design program. With x, y = X/Z, Y/Z in
// camera axes, the place moves by
//     dx = x_0 + x_1 x + x_2 y + x_3 x^2 + x_4 x y + x_5 y^2 + x_6 x^3 ..., and the same for dy.
// Terms are sorted by order and, within an order, by falling powers of x, up to the fifth order. It resembles
// SIP of FITS headers (Shupe et al., ADASS XIV, 491, 2005), but includes the constant and linear terms, which
// SIP leaves to the rest of the header.

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "render/vocabulary/vec.h"

namespace hilcam {

struct LensPolynomial {
    static constexpr int kMaxOrder = 5;
    static constexpr std::size_t kMaxTerms = (kMaxOrder + 1) * (kMaxOrder + 2) / 2;

    std::array<double, kMaxTerms> x{}, y{};
    int order = -1;  // highest order that is used; -1: no distortion

    bool none() const { return order < 0; }
    // The terms up to `order`.
    std::span<const double> terms_x() const { return {x.data(), terms_of(order)}; }
    std::span<const double> terms_y() const { return {y.data(), terms_of(order)}; }

    // The shift of a place, and the derivatives of that shift by x and by y.
    struct Shift {
        Vec2d by, along_x, along_y;
    };
    Shift shift(Vec2d p) const {
        Shift out{};
        std::array<double, kMaxOrder + 1> px{1}, py{1};  // powers
        for (std::size_t n = 1; n <= kMaxOrder; ++n) px[n] = px[n - 1] * p.x, py[n] = py[n - 1] * p.y;
        std::size_t term = 0;
        for (int n = 0; n <= order; ++n)
            for (int j = 0; j <= n; ++j, ++term) {
                const auto a = static_cast<std::size_t>(n - j), b = static_cast<std::size_t>(j);
                const double value = px[a] * py[b];
                const double by_x = a == 0 ? 0 : static_cast<double>(a) * px[a - 1] * py[b];
                const double by_y = b == 0 ? 0 : static_cast<double>(b) * px[a] * py[b - 1];
                out.by.x += x[term] * value, out.by.y += y[term] * value;
                out.along_x.x += x[term] * by_x, out.along_x.y += y[term] * by_x;
                out.along_y.x += x[term] * by_y, out.along_y.y += y[term] * by_y;
            }
        return out;
    }

  private:
    static std::size_t terms_of(int order) { return static_cast<std::size_t>((order + 1) * (order + 2) / 2); }
};

// Returns the polynomial whose terms are given for places and shifts in millimetres on the image plane. At
// most LensPolynomial::kMaxTerms of each; missing terms are zero.
inline LensPolynomial lens_polynomial(std::span<const double> x_mm, std::span<const double> y_mm,
                                      double focal_length_mm) {
    LensPolynomial out;
    double unit = 1 / focal_length_mm;  // the unit of an order's terms
    for (std::size_t n = 0, first = 0; first < std::max(x_mm.size(), y_mm.size()); first += ++n) {
        out.order = static_cast<int>(n);
        for (std::size_t i = first; i <= first + n; ++i) {
            if (i < x_mm.size()) out.x[i] = x_mm[i] * unit;
            if (i < y_mm.size()) out.y[i] = y_mm[i] * unit;
        }
        unit *= focal_length_mm;
    }
    return out;
}

}  // namespace hilcam
