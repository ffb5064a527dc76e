#include "render/earth/adding_doubling.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

using Index = std::size_t;

// A square matrix, row by row. A product of two is a sum over the quadrature: sum_k a_ik 2 mu_k w_k b_kj.
using Matrix = std::vector<double>;

struct Quadrature {
    std::vector<double> mu, weight;  // weight: 2 mu w; zero at the given cosines, which come last
    Index gauss = 0;
    Index size() const { return mu.size(); }
};

// Gauss-Legendre points on (0, 1), by Newton's iteration.
Quadrature quadrature_of(int streams, std::span<const double> cosines) {
    Quadrature q;
    q.gauss = static_cast<Index>(streams);
    for (int i = 0; i < streams; ++i) {
        double x = std::cos(kPi * (i + 0.75) / (streams + 0.5)), slope = 1;
        for (int step = 0; step < 50; ++step) {
            double p0 = 1, p1 = x;
            for (int l = 2; l <= streams; ++l) {
                const double next = ((2 * l - 1) * x * p1 - (l - 1) * p0) / l;
                p0 = p1, p1 = next;
            }
            slope = streams * (x * p1 - p0) / (x * x - 1);
            const double change = p1 / slope;
            x -= change;
            if (std::abs(change) < 1e-15) break;
        }
        const double mu = 0.5 * (1 + x), w = 1 / ((1 - x * x) * slope * slope);
        q.mu.push_back(mu), q.weight.push_back(2 * mu * w);
    }
    for (const double c : cosines) q.mu.push_back(c), q.weight.push_back(0);
    return q;
}

Matrix product(const Matrix& a, const Matrix& b, const Quadrature& q) {
    const Index n = q.size();
    Matrix out(n * n);
    for (Index i = 0; i < n; ++i)
        for (Index k = 0; k < q.gauss; ++k) {
            const double factor = a[i * n + k] * q.weight[k];
            for (Index j = 0; j < n; ++j) out[i * n + j] += factor * b[k * n + j];
        }
    return out;
}

// Solves S = Q + Q S (the sum of all powers of Q): rows of the quadrature by elimination, then the others by
// one product.
Matrix all_powers(const Matrix& q_matrix, const Quadrature& q) {
    const Index n = q.size(), g = q.gauss;
    Matrix left(g * g), s(n * n);
    for (Index i = 0; i < g; ++i) {
        for (Index j = 0; j < g; ++j) left[i * g + j] = (i == j) - q_matrix[i * n + j] * q.weight[j];
        std::copy_n(q_matrix.begin() + static_cast<std::ptrdiff_t>(i * n), n,
                    s.begin() + static_cast<std::ptrdiff_t>(i * n));
    }
    // 1 - Q of a layer is diagonally dominant, so no pivoting is needed.
    for (Index k = 0; k < g; ++k)
        for (Index i = 0; i < g; ++i) {
            if (i == k) continue;
            const double factor = left[i * g + k] / left[k * g + k];
            for (Index j = k; j < g; ++j) left[i * g + j] -= factor * left[k * g + j];
            for (Index j = 0; j < n; ++j) s[i * n + j] -= factor * s[k * n + j];
        }
    for (Index i = 0; i < g; ++i)
        for (Index j = 0; j < n; ++j) s[i * n + j] /= left[i * g + i];
    for (Index i = g; i < n; ++i)
        for (Index j = 0; j < n; ++j) {
            double sum = q_matrix[i * n + j];
            for (Index k = 0; k < g; ++k) sum += q_matrix[i * n + k] * q.weight[k] * s[k * n + j];
            s[i * n + j] = sum;
        }
    return s;
}

struct Layer {
    double thickness;
    Matrix r, t;
};

// Combines layer a above layer b, both of the same kind (Hansen & Travis 1974, eqs. 3.1-3.6).
Layer together(const Layer& a, const Layer& b, const Quadrature& q) {
    const Index n = q.size();
    std::vector<double> ea(n), eb(n);
    for (Index i = 0; i < n; ++i)
        ea[i] = std::exp(-a.thickness / q.mu[i]), eb[i] = std::exp(-b.thickness / q.mu[i]);
    const Matrix s = all_powers(product(a.r, b.r, q), q);
    Matrix d = product(s, a.t, q);
    for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j) d[i * n + j] += a.t[i * n + j] + s[i * n + j] * ea[j];
    Matrix u = product(b.r, d, q);
    for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j) u[i * n + j] += b.r[i * n + j] * ea[j];
    Layer out{a.thickness + b.thickness, product(a.t, u, q), product(b.t, d, q)};
    for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j) {
            out.r[i * n + j] += a.r[i * n + j] + ea[i] * u[i * n + j];
            out.t[i * n + j] += eb[i] * d[i * n + j] + b.t[i * n + j] * ea[j];
        }
    return out;
}

// Returns the Legendre functions sqrt((l - m)! / (l + m)!) P_l^m(mu), l = m ... count - 1.
std::vector<double> legendre(int m, int count, double mu) {
    std::vector<double> out(static_cast<Index>(count));
    double first = 1;
    for (int k = 1; k <= m; ++k) first *= std::sqrt((2 * k - 1) / (2.0 * k) * (1 - mu * mu));
    double before = 0, here = first;
    for (int l = m; l < count; ++l) {
        out[static_cast<Index>(l)] = here;
        const double next = ((2 * l + 1) * mu * here - std::sqrt(1.0 * l * l - m * m) * before) /
                            std::sqrt((l + 1.0) * (l + 1) - m * m);
        before = here, here = next;
    }
    return out;
}

// Returns a thin layer with single scattering only.
Layer thin_layer(int mode, double thickness, const std::vector<double>& moments, double albedo,
                 const Quadrature& q) {
    const Index n = q.size();
    const int count = static_cast<int>(moments.size());
    std::vector<std::vector<double>> lambda;
    for (const double mu : q.mu) lambda.push_back(legendre(mode, count, mu));
    Layer out{thickness, Matrix(n * n), Matrix(n * n)};
    for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j) {
            double forward = 0, backward = 0;
            for (int l = mode; l < count; ++l) {
                const auto k = static_cast<Index>(l);
                const double term = (2 * l + 1) * moments[k] * lambda[i][k] * lambda[j][k];
                forward += term;
                backward += (l + mode) % 2 ? -term : term;
            }
            const double mi = q.mu[i], mj = q.mu[j];
            const double si = thickness / mi, sj = thickness / mj;
            out.r[i * n + j] = 0.25 * albedo * backward / (mi + mj) * -std::expm1(-(si + sj));
            // (e^-si - e^-sj) / (mi - mj), with its limit where the two coincide.
            const double apart = sj - si;
            const double ratio = std::abs(apart) > 1e-9 ? -std::expm1(-apart) / apart : 1 - 0.5 * apart;
            out.t[i * n + j] = 0.25 * albedo * forward * thickness / (mi * mj) * std::exp(-si) * ratio;
        }
    return out;
}

}  // namespace

double phase_of_moments(std::span<const double> moments, double cosine) {
    double sum = 0, p0 = 1, p1 = cosine;
    for (Index l = 0; l < moments.size(); ++l) {
        const double m = static_cast<double>(l);
        sum += (2 * m + 1) * moments[l] * p0;
        const double next = ((2 * m + 3) * cosine * p1 - (m + 1) * p0) / (m + 2);
        p0 = p1, p1 = next;
    }
    return sum;
}

ScatteringLayers scattering_layers(std::span<const double> moments, int streams,
                                   std::span<const double> cosines, int first_power, int last_power,
                                   double albedo) {
    const auto count = static_cast<Index>(2 * streams);
    HILCAM_CHECK(streams > 0 && moments.size() > count && first_power <= last_power);
    ScatteringLayers out;
    out.streams = streams;
    const double f = out.forward_share = moments[count];
    for (Index l = 0; l < count; ++l) out.scaled_moments.push_back((moments[l] - f) / (1 - f));
    out.cosines.assign(cosines.begin(), cosines.end());
    // Similarity: forward-scattered light counts as not scattered (Wiscombe 1977, eq. 12).
    const double left = (1 - f) * albedo / (1 - f * albedo);
    const Quadrature q = quadrature_of(streams, cosines);
    const Index n = q.size(), g = q.gauss, asked = cosines.size();
    const auto layers = static_cast<Index>(2 * (last_power - first_power) + 1);
    out.layers.resize(layers);
    for (ScatteringLayer& layer : out.layers)
        layer.reflection.resize(count), layer.transmission.resize(count);

    tbb::parallel_for(0, static_cast<int>(count), [&](int mode) {
        // Single scattering is wrong by the thickness over the smallest cosine: with this start a thick layer
        // loses 1e-4.
        constexpr int kThinnest = -24;
        Layer layer = thin_layer(mode, std::exp2(kThinnest), out.scaled_moments, left, q);
        Layer half = layer;
        const auto keep = [&](const Layer& from, ScatteringLayer& to) {
            Matrix r(asked * asked), t(asked * asked);
            for (Index i = 0; i < asked; ++i)
                for (Index j = 0; j < asked; ++j) {
                    r[i * asked + j] = from.r[(g + i) * n + g + j];
                    t[i * asked + j] = from.t[(g + i) * n + g + j];
                }
            to.reflection[static_cast<Index>(mode)] = std::move(r);
            to.transmission[static_cast<Index>(mode)] = std::move(t);
            if (mode > 0) return;
            to.thickness = from.thickness;  // that of all modes
            to.plane_albedo.assign(asked, 0), to.transmitted.assign(asked, 0);
            for (Index j = 0; j < asked; ++j) {
                for (Index i = 0; i < g; ++i) {
                    to.plane_albedo[j] += q.weight[i] * from.r[i * n + g + j];
                    to.transmitted[j] += q.weight[i] * from.t[i * n + g + j];
                }
                to.transmitted[j] += std::exp(-from.thickness / q.mu[g + j]);
            }
            for (Index i = 0; i < g; ++i)
                for (Index j = 0; j < g; ++j)
                    to.spherical_albedo += q.weight[i] * q.weight[j] * from.r[i * n + j];
        };
        for (int power = kThinnest; power <= last_power; ++power) {
            if (power > first_power)
                keep(together(half, layer, q), out.layers[static_cast<Index>(2 * (power - first_power)) - 1]);
            if (power >= first_power) keep(layer, out.layers[static_cast<Index>(2 * (power - first_power))]);
            if (power == last_power) break;
            half = layer;
            layer = together(layer, layer, q);
        }
    });
    // 1.5 2^k, combined from 2^(k-1) and 2^k, was stored before 2^k, which is thinner.
    std::sort(out.layers.begin(), out.layers.end(),
              [](const ScatteringLayer& a, const ScatteringLayer& b) { return a.thickness < b.thickness; });
    return out;
}

}  // namespace hilcam
